"""What is built to be installed holds all that runs, and nothing that only builds."""

import subprocess
import tarfile
import zipfile
from pathlib import Path

import pytest
import tomlkit

ROOT = Path(__file__).parents[1]
VIEWER = "src/murkscan/view/viewer"
BUILDS_ONLY = tuple(f"{VIEWER}/{name}" for name in ("source/", "package", "build.js", ".npmrc"))


def kept_files():
    """Name the files of the package that are under version control, but those that build a page."""
    asked = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "src/murkscan"]
    try:
        said = subprocess.run(asked, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("this is no checkout")
    names = (name for name in said.splitlines() if (ROOT / name).is_file())
    return {name for name in names if not name.startswith(BUILDS_ONLY)}


def build(kind, folder):
    builders = pytest.importorskip(f"hatchling.builders.{kind}", reason="hatchling is absent")
    builder = getattr(builders, {"wheel": "WheelBuilder", "sdist": "SdistBuilder"}[kind])
    return next(builder(str(ROOT)).build(directory=str(folder), versions=["standard"]))


def test_citation_and_changelog_are_of_this_version():
    version = tomlkit.parse((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["version"]
    assert f"version: {version}\n" in (ROOT / "CITATION.cff").read_text("utf-8")
    assert f"## [{version}]" in (ROOT / "CHANGELOG.md").read_text("utf-8")


def test_the_wheel_holds_the_package_with_its_data_and_nothing_else(tmp_path):
    names = set(zipfile.ZipFile(build("wheel", tmp_path)).namelist())
    package = {f"src/{name}" for name in names if name.startswith("murkscan/")}
    assert package == kept_files()
    others = {Path(name).name for name in names if not name.startswith("murkscan/")}
    assert others == {"METADATA", "WHEEL", "RECORD", "entry_points.txt", "LICENSE"}


def test_the_source_distribution_holds_what_the_wheel_is_made_of(tmp_path):
    with tarfile.open(build("sdist", tmp_path)) as archive:
        names = {
            name.partition("/")[2]
            for name in archive.getnames()
            if archive.getmember(name).isfile()
        }
    wanted = {"README.md", "CHANGELOG.md", "CITATION.cff", "LICENSE", "pyproject.toml", "PKG-INFO"}
    assert names - {".gitignore"} == kept_files() | wanted
