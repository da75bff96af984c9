"""Tell how a scan went: the same numbers for people and for programs."""

from .belief import Belief as Belief
from .calibrated import CalibrationStep as CalibrationStep
from .coverage import Coverage as Coverage
from .coverage import map_coverage as map_coverage
from .directions import SurfaceDirections as SurfaceDirections
from .histogram import Histogram as Histogram
from .html import as_html as as_html
from .plain import as_json as as_json
from .reach import Reach as Reach
from .recorded import Model as Model
from .recorded import Recorded as Recorded
from .recorded import Shown as Shown
from .spacing import spacing_across as spacing_across
from .spacing import spacing_along as spacing_along
from .speed import Speed as Speed
from .speed import judge_speed as judge_speed
from .spread import Spread as Spread
from .summary import ScanSummary as ScanSummary
from .summary import summarise as summarise
from .summary import with_coverage as with_coverage
from .swath import CAUSES as CAUSES
from .swath_layout import SwathLayout as SwathLayout
from .timeline import FrameStatistics as FrameStatistics
from .timeline import Timeline as Timeline
from .timeline import frame_statistics as frame_statistics
from .timeline import make_timeline as make_timeline
