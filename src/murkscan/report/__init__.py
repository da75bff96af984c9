"""Tell how a scan went: the same numbers for people and for programs."""

from .html import as_html as as_html
from .plain import as_json as as_json
from .spacing import spacing_across as spacing_across
from .spacing import spacing_along as spacing_along
from .spread import Spread as Spread
from .summary import Model as Model
from .summary import Recorded as Recorded
from .summary import ScanSummary as ScanSummary
from .summary import Shown as Shown
from .summary import summarise as summarise
from .timeline import FrameStatistics as FrameStatistics
from .timeline import Timeline as Timeline
from .timeline import frame_statistics as frame_statistics
from .timeline import make_timeline as make_timeline
