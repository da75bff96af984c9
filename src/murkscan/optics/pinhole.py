"""The same names as in `view`, until all import them from the room's face."""

from .view import back_project as back_project
from .view import normalise as normalise
from .view import project as project
