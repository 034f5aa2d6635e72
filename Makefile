.DEFAULT_GOAL := help
.PHONY: help install demo paper test lint quick validate compatibility mutation browser bench docs wheel lock clean

PYTHON ?= python3
BIN := .venv/bin
STAMP := .venv/.installed
SHIPPED := src/beltdyn/kernel/shipped
PARALLEL := --numprocesses auto --dist worksteal
BY_FILE := --numprocesses auto --dist loadfile
# s, a test that computes hundreds of runs at first is no test that hangs
LONG := --override-ini faulthandler_timeout=7200

# processes that tests start would read all sources anew
unexport PYTHONDONTWRITEBYTECODE
# a process for each core leaves none to threads
quick validate: export OPENBLAS_NUM_THREADS := 1

help: ## list the targets
	@grep -hE '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12

install: $(STAMP) ## make .venv with the locked versions and beltdyn itself, and compile the usual kernels

$(STAMP): requirements.lock pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/pip install --quiet --requirement requirements.lock
	$(BIN)/pip install --quiet --no-deps --no-build-isolation --editable .
	$(BIN)/beltdyn compile
	@touch $@

demo: install ## start a fan through V-belts, with a summary and figures
	$(BIN)/beltdyn demo

paper: install ## the paper's statements beside our results, in beltdyn-paper/paper.html
	$(BIN)/python -m validation.paper

test: install ## linters, types, layers, unit and verification tests
	$(MAKE) --no-print-directory --jobs=2 lint quick

lint: install ## linters, types, layers, and that the tests of `make validate` can be read
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/pytest -qqq --collect-only $(wildcard tests/validation)

quick: install ## unit and verification tests but the slow ones
	$(BIN)/pytest $(PARALLEL) -m "not slow" $(wildcard tests/unit tests/verification tests/fuzz)

validate: install ## slow verification tests and comparisons with the literature
	$(BIN)/pytest $(PARALLEL) $(LONG) -m slow $(wildcard tests/unit tests/verification tests/fuzz)
	$(if $(wildcard tests/validation),$(BIN)/pytest $(BY_FILE) $(LONG) tests/validation)
	$(MAKE) compatibility

compatibility: ## kernels with the oldest Numba, the last one known and the newest, each in an environment of its own
	for version in ==0.60.* ==0.68.* ""; do \
		rm -rf .venv-numba && $(PYTHON) -m venv .venv-numba && \
		.venv-numba/bin/pip install --quiet "numba$$version" pytest hypothesis . && \
		.venv-numba/bin/python -c "import numba; print('Numba', numba.__version__)" && \
		BELTDYN_CACHE_DIR=.venv-numba/kernels .venv-numba/bin/python -m pytest --quiet --compiled tests/unit/kernel \
			tests/unit/contact tests/unit/elements tests/unit/machines tests/unit/stretch tests/unit/system || exit 1; \
	done
	rm -rf .venv-numba

mutation: install ## small changes of the sources, taken at random, and how many of them the tests notice
	$(BIN)/python -m tools.mutation elements contact machines system results/derived points state transient vibration \
		designs --sample 150

browser: install ## the page of `beltdyn app` in a real Chromium, which must be installed (or named in BELTDYN_BROWSER)
	$(BIN)/pip install --quiet playwright
	$(BIN)/pytest tests/browser

bench: install ## benchmarks; all of them run, and it fails if any has failed
	failed=0; for script in benchmarks/*.py; do $(BIN)/python $$script || failed=1; done; exit $$failed

docs: install ## the documentation, in docs/_build/html
	$(BIN)/sphinx-build -W --keep-going -b html docs docs/_build/html

wheel: install ## a wheel for this system and Python, in dist, with the usual kernels compiled
	rm -rf $(SHIPPED)
	BELTDYN_CACHE_DIR=$(SHIPPED) $(BIN)/beltdyn compile
	$(BIN)/hatchling build --target wheel
	rm -rf $(SHIPPED)

lock: ## resolve the versions anew
	$(PYTHON) -m venv .venv
	$(BIN)/pip install --quiet uv
	$(BIN)/uv pip compile --quiet --universal --upgrade --python-version 3.11 --all-extras --group dev \
		--no-header --no-emit-index-url --no-emit-find-links pyproject.toml --output-file requirements.lock

clean: ## remove everything that can be made again
	rm -rf .venv .venv-numba .mypy_cache .pytest_cache .ruff_cache .import_linter_cache .hypothesis \
		dist docs/_build beltdyn-demo beltdyn-paper
	find src tests -name __pycache__ -type d -exec rm -rf {} +
