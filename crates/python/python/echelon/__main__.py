"""`python -m echelon` is the program `echelon`."""

import sys

from ._program import main

sys.exit(main())
