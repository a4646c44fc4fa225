import sys

from scree.cli import main

sys.exit(main())
