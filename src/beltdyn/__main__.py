"""The command line as ``python -m beltdyn``, without the modules of the working folder, which Python puts first."""

import sys

if __name__ == "__main__":
    if not sys.flags.safe_path:
        sys.path.pop(0)

    from beltdyn.cli import main

    main()
