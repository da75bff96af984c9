"""Find out what the camera and the laser are, from photos of a board, and what that is worth."""

from .board import Chessboard as Chessboard
from .board import Margin as Margin
from .camera import PARAMETERS as PARAMETERS
from .camera import CameraCalibration as CameraCalibration
from .camera import calibrate_camera as calibrate_camera
from .camera import locate_board as locate_board
from .contrast import laser_contrast as laser_contrast
from .contrast import white_of_board as white_of_board
from .corners import find_board as find_board
from .coverage import Coverage as Coverage
from .coverage import coverage_of as coverage_of
from .sheet import LaserCalibration as LaserCalibration
from .sheet import StripeOnBoard as StripeOnBoard
from .sheet import calibrate_laser as calibrate_laser
from .stripe_on_board import keep_on_board as keep_on_board
from .stripe_on_board import mask_to_sheet as mask_to_sheet
from .verdict import CalibrationVerdict as CalibrationVerdict
from .verdict import distances_of as distances_of
from .verdict import judge_camera as judge_camera
from .verdict import judge_laser as judge_laser
from .view import BoardView as BoardView
