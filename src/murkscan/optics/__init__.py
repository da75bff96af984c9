"""How light travels: no files, no images, no settings."""

from .pinhole import back_project as back_project
from .pinhole import normalise as normalise
from .pinhole import project as project
