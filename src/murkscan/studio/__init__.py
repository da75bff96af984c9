"""The web application: what the commands do, in a browser, from one folder.

Each thing done here is one command, run as its own process, and shown as it would be typed.
"""

from .app import make_app as make_app
from .serve import serve as serve
