"""Find out what the camera and the laser are, from photos of a board, and what that is worth."""

from .adjust.parameters import INTRINSICS as INTRINSICS
from .board.chessboard import Chessboard as Chessboard
from .board.chessboard import Margin as Margin
from .board.contrast import laser_contrast as laser_contrast
from .board.contrast import white_of_board as white_of_board
from .board.corners import find_board as find_board
from .board.coverage import BoardCoverage as BoardCoverage
from .board.coverage import cover as cover
from .board.marker import find_markers as find_markers
from .board.marker import load_dictionary as load_dictionary
from .board.pose import locate_seen_board as locate_seen_board
from .board.stripe import StripeOnBoard as StripeOnBoard
from .board.view import BoardView as BoardView
from .calibration import Calibration as Calibration
from .camera import calibrate_camera as calibrate_camera
from .laser import calibrate_lasers as calibrate_lasers
from .laser import sheet_of as sheet_of
from .mount import MeasuredPlace as MeasuredPlace
from .mount import calibrate_mount as calibrate_mount
from .mount import circles_of as circles_of
from .port import calibrate_port as calibrate_port
from .sheet import SheetFit as SheetFit
from .sheet import fit_sheet as fit_sheet
from .verdict import CalibrationVerdict as CalibrationVerdict
from .verdict import judge as judge
