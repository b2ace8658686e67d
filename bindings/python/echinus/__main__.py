"""python3 -m echinus: what the package does from a shell."""

import sys

from echinus.corpus._command import main, parse

if __name__ == "__main__":
    sys.exit(main(parse()))
