"""From a folder of pictures, a video, a stream or a camera to frames with times."""

from .base import AbstractRecording as AbstractRecording
from .base import Skip as Skip
from .base import ignore_skip as ignore_skip
from .colour import grey_from_colour as grey_from_colour
from .folder import ImageFolder as ImageFolder
from .open import Fields as Fields
from .open import open_recording as open_recording
from .video import Video as Video
