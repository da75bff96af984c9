"""The face of the package: the names that users import, and that importing costs nothing."""

import subprocess
import sys

import murkscan

NAMES = {
    "align_clouds", "Ball", "BaselineAngle", "Box", "calibrate_camera_from_photos",
    "calibrate_laser_from_photos", "calibrate_mount_from_photos", "calibrate_port_from_photos",
    "Camera", "check_in_scan", "Chessboard", "compare_scan", "ConstantSpeed", "ConstantStep",
    "Degenerate", "DeviceError", "EstimationError", "FormatError", "Frame", "GaussianFit",
    "GrayGravity", "GridMesh", "InputError", "Laser", "load_cloud_file", "load_poses",
    "load_reference", "load_rig", "measure_cylinder", "measure_distance", "measure_plane",
    "measure_points", "measure_sphere", "Mesh", "MissingDependency", "MissingResult", "Murk",
    "MurkscanError", "NotConverged", "NotEnoughData", "open_recording", "Plane", "PointCloud",
    "Poisson", "Pose", "PoseLog", "Profile", "Project", "RaySheet", "Rig", "save_rig", "scan",
    "search_dents", "Steger", "Stripe", "thin_cloud", "ThresholdSkeleton", "Trajectory",
}  # fmt: skip


def test_the_face_is_this_list():
    assert set(murkscan.__all__) == NAMES


def test_every_name_is_there_and_documented():
    for name in NAMES:
        assert getattr(murkscan, name).__doc__, name


def test_importing_murkscan_imports_nothing_heavy():
    code = "import sys, murkscan; print([m for m in ('numpy', 'cv2', 'scipy') if m in sys.modules])"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout.strip() == "[]"
