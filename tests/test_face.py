"""The face of the package: the names that users import, and that importing costs nothing."""

import subprocess
import sys

import murkscan

NAMES = {
    "BaselineAngle", "Camera", "ConstantSpeed", "ConstantStep", "Degenerate", "DeviceError",
    "EstimationError", "FormatError", "Frame", "GaussianFit", "GrayGravity", "GridMesh",
    "InputError", "Laser", "Mesh", "MissingDependency", "MissingResult", "MurkscanError",
    "NotConverged", "NotEnoughData", "Plane", "PointCloud", "Poisson", "Pose", "PoseLog", "Profile",
    "Murk", "Project", "RaySheet", "Rig", "Steger", "Stripe", "ThresholdSkeleton", "Trajectory",
    "align_clouds", "load_cloud_file", "load_poses", "load_rig", "open_recording", "save_rig",
    "scan", "thin_cloud",
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
