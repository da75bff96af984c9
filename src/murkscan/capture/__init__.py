"""From a folder of pictures, a video, a stream or a camera to frames with times."""

from .arrived import ArrivedFrame as ArrivedFrame
from .arrived import ArrivedPicture as ArrivedPicture
from .arrived import FrameSplitter as FrameSplitter
from .arrived import StreamDecoder as StreamDecoder
from .base import AbstractRecording as AbstractRecording
from .base import Skip as Skip
from .base import ignore_skip as ignore_skip
from .camera import camera_images as camera_images
from .camera import is_camera as is_camera
from .coded import CodedPicture as CodedPicture
from .colour import LaserColour as LaserColour
from .field_order import Fields as Fields
from .folder import ImageFolder as ImageFolder
from .growing import RecordingProgress as RecordingProgress
from .long_recording import DiveFolder as DiveFolder
from .long_recording import DiveProgress as DiveProgress
from .long_recording import DiveRecord as DiveRecord
from .long_recording import check_source as check_source
from .long_recording import record_dive as record_dive
from .open import open_recording as open_recording
from .record import record_images as record_images
from .stream import copy_stream as copy_stream
from .stream import is_stream as is_stream
from .video import Video as Video
