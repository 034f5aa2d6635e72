"""Drive files with mistakes: changes of the examples in values, types, units, keys, structure, bytes and tables."""

import re
from collections.abc import Callable
from importlib.resources import files
from random import Random

NUMBER = re.compile(r"(?<![\w.\"])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?![\w.\"])")
QUANTITY = re.compile(r'"-?\d[^"\n]*"')
TEXT = re.compile(r'"[^"\n]*"')
KEY = re.compile(r"^(\w+) *=", re.MULTILINE)
LONG = 20_000

VALUES = (
    *("0", "0.0", "-0.0", "-1", "1", "2", "3", "1e-12", "1e-15", "1e-300", "5e-324", "1e15", "1e16", "1e300"),
    *("nan", "inf", "-inf", "true", "false", "[]", "[1]", "[0, 0]", "[nan, 1]", "[[1, 2], [3, 4]]", "{}", "{ a = 1 }"),
    *("2006-05-13", "07:32:00", "2006-05-13T07:32:00Z", "0x7fffffffffffffff", "1_000", "9" * 400, "9" * 5000),
    *('""', '"text"', '"1 m"', '"-1 mm"', '"1 kg"', '"1e400 m"', '"nan m"', '"1 m**9"', '"1 m/m"', '"1 Hz"', '"1 °"'),
    *('"10 rpm"', '"1 N*m"', '"' + "x" * LONG + '"', "[" * 40 + "]" * 40, "[" + "1, " * LONG + "]", "'''\n1\n'''"),
    *('{ kind = "table", times = [0, 1], values = [0, 1] }', '{ kind = "table", times = [1, 0], values = [0, 1] }'),
    *('{ kind = "table", times = [0, 1], values = [0] }', '{ kind = "table", times = [], values = [] }'),
    *('{ kind = "constant", value = 1e15 }', '{ kind = "step", time = 0.5, value = 1 }', '{ kind = "text" }'),
    *(
        f'{{ kind = "table", file = "{name}" }}'
        for name in ("table.csv", "wrong.csv", "missing.csv", ".", "", "\\u0000")
    ),
)
LINES = (
    *(
        "a." * 1000 + "b = 1",
        "[a]",
        "[[pulley]]",
        "[belt]",
        "[pulley]",
        "[[tensioner]]",
        "x = ",
        "= 1",
        "[",
        "]]",
        '"""',
    ),
    *('gravity = [0, "-9.81 m/s^2"]', "gravity = [1e15, 0]", "gravity = 3", "crossed = true", 'side = "outside"'),
    *('side = "inside"', 'installed_tension = "100 N"', "installed_tension = 1e-12", "installed_tension = 1e15"),
    *("belt.length = 1", 'catalogue = "table.csv"', 'profile = "PK"', "ribs = 6", "pitch_offset = 1", "friction = 1e9"),
    *("diameter = 0.1", "diameter = -1", "nominal_length = 1.3", 'nominal_length = "1 m^2"', 'profile = "round-85A"'),
    *('allowed_penetration = "1 um"', "allowed_penetration = 1", 'discretization = "truss"', "elements = 3"),
    *("elements = 9999", "inertia = 0", "inertia = 1e-15", "max_step = 1e-15", "rtol = 1e-15", "spectral_radius = 0"),
    '[[tensioner]]\npulley = "driven"\nkind = "fixed"\ndirection = [1, 0]\ntake_up = 0.01',
    '[[tensioner]]\npulley = "driven"\nkind = "sliding"\ndirection = [0, 0]\npreload = 1\nrate = 1\nmass = 1',
    '[[tensioner]]\npulley = "driven"\nkind = "sliding"\ndirection = [1, 0]\npreload = 1e9\nrate = 1e-9\nmass = 1',
    '[[tensioner]]\npulley = "driven"\nkind = "rotary"\npivot = [0.2, 0.3]\npreload = 1\nrate = 1\ninertia = 1',
)
TABLES = (
    *("0,0\n1,1\n", "time,torque\n0,0\n1,1\n", "", "a\n", "0,0\n0,0\n", "1,0\n0,1\n", "0,nan\n1,inf\n", "0;0\n1;1\n"),
    *("0,0\n1\n", "0,0,0\n", '"0","0"\n"1', "0,1e400\n1,0\n", "x" * LONG, "\0", "0,0\n" * LONG, "a,b\n" * LONG),
)


def bases() -> list[str]:
    """Texts of the examples."""
    folder = files("beltdyn").joinpath("examples")
    names = sorted(file.name for file in folder.iterdir() if file.name.endswith(".toml"))
    return [folder.joinpath(name).read_text(encoding="utf-8") for name in names]


def mutated(seed: int, originals: list[str]) -> tuple[bytes, bytes]:
    """A drive file, and the table ``table.csv`` that lies beside it.

    Parameters
    ----------
    seed : int
        The same files for the same number.
    originals : list of str
        What is changed, from `bases`.
    """
    random = Random(seed)
    text = random.choice(originals)
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        text = random.choice(CHANGES)(text, random)
    data = text.encode("utf-8", "surrogatepass")
    if random.random() < 0.1:
        data = random.choice(DAMAGES)(data, random)
    return data, random.choice(TABLES).encode()


def _replaced(pattern: re.Pattern[str], text: str, random: Random, new: Callable[[str], str]) -> str:
    """Replace one of the places where a pattern is found."""
    found = list(pattern.finditer(text))
    if not found:
        return text
    one = random.choice(found)
    return text[: one.start()] + new(one.group()) + text[one.end() :]


def scale(text: str, random: Random) -> str:
    return _replaced(NUMBER, text, random, lambda old: f"{float(old) * 10 ** random.uniform(-13, 13):.6g}")


def nudge(text: str, random: Random) -> str:
    return _replaced(NUMBER, text, random, lambda old: f"{float(old) * random.choice((-1, 0.5, 0.9, 1.1, 2, 10)):.6g}")


def replace_number(text: str, random: Random) -> str:
    return _replaced(NUMBER, text, random, lambda _: random.choice(VALUES))


def extreme(text: str, random: Random) -> str:
    """Any magnitude that a computer has, in place of a number with or without a unit."""
    number = f"{random.choice(('', '-'))}1e{random.randint(-323, 308)}"
    return _replaced(random.choice((NUMBER, QUANTITY)), text, random, lambda _: number)


def replace_text(text: str, random: Random) -> str:
    return _replaced(TEXT, text, random, lambda _: random.choice(VALUES))


def replace_value(text: str, random: Random) -> str:
    return _replaced(re.compile(r"(?<== ).*$", re.MULTILINE), text, random, lambda _: random.choice(VALUES))


def exchange_texts(text: str, random: Random) -> str:
    return _replaced(TEXT, text, random, lambda _: random.choice(TEXT.findall(text)))


def exchange_numbers(text: str, random: Random) -> str:
    return _replaced(NUMBER, text, random, lambda _: random.choice(NUMBER.findall(text)))


def rename_key(text: str, random: Random) -> str:
    return _replaced(KEY, text, random, lambda old: random.choice(("x", old.replace(" ", "")[:-2], "a.b.c")) + " =")


def exchange_keys(text: str, random: Random) -> str:
    return _replaced(KEY, text, random, lambda _: random.choice(KEY.findall(text)) + " =")


def insert_line(text: str, random: Random) -> str:
    lines = text.split("\n")
    lines.insert(random.randrange(len(lines) + 1), random.choice(LINES))
    return "\n".join(lines)


def delete_line(text: str, random: Random) -> str:
    lines = text.split("\n")
    del lines[random.randrange(len(lines))]
    return "\n".join(lines)


def repeat_line(text: str, random: Random) -> str:
    lines = text.split("\n")
    lines.insert(random.randrange(len(lines)), random.choice(lines))
    return "\n".join(lines)


def exchange_groups(text: str, random: Random) -> str:
    groups = re.split(r"(?m)^(?=\[)", text)
    first, second = random.randrange(len(groups)), random.randrange(len(groups))
    groups[first] = groups[second] if random.random() < 0.5 else ""
    return "".join(groups)


def cut(text: str, random: Random) -> str:
    return text[: random.randrange(len(text) + 1)]


def change_letters(text: str, random: Random) -> str:
    letters = list(text)
    for _ in range(random.choice((1, 2, 8))):
        place = random.randrange(len(letters) + 1)
        letters[place : place + random.choice((0, 1))] = random.choice('[]{}="\\#.,-+eE0 \n\t\0\x7fäπ\ufeff\u202e')
    return "".join(letters)


CHANGES: tuple[Callable[[str, Random], str], ...] = (
    *(scale, nudge, extreme, replace_number, replace_text, replace_value, exchange_texts, exchange_numbers, rename_key),
    *(exchange_keys, insert_line, delete_line, repeat_line, exchange_groups, cut, change_letters),
)


def flip_bytes(data: bytes, random: Random) -> bytes:
    changed = bytearray(data or b"\0")
    for _ in range(random.choice((1, 4, 64))):
        changed[random.randrange(len(changed))] = random.randrange(256)
    return bytes(changed)


def other_encoding(data: bytes, random: Random) -> bytes:
    return data.decode(errors="replace").encode(random.choice(("utf-16", "utf-32", "cp1252", "utf-8-sig")), "replace")


def cut_bytes(data: bytes, random: Random) -> bytes:
    return data[: random.randrange(len(data) + 1)]


def other_lines(data: bytes, random: Random) -> bytes:
    return data.replace(b"\n", random.choice((b"\r\n", b"\r", b"\0")))


DAMAGES: tuple[Callable[[bytes, Random], bytes], ...] = (flip_bytes, other_encoding, cut_bytes, other_lines)
