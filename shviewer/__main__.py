"""python -m shviewer, and the command shviewer."""

import sys

from shviewer.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
