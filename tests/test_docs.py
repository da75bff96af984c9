"""What the README shows runs, and what pages link to is there."""

import re
import shutil
from pathlib import Path

import pytest

pytestmark = pytest.mark.without_types

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_link_leads_somewhere(page):
    links = re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text("utf-8"))
    missing = [link for link in links if "://" not in link and not (page.parent / link).exists()]
    assert missing == []


def test_the_readme_s_python_runs_as_printed(hull, tmp_path, monkeypatch):
    """Its recording is a folder here, of twenty frames; a path is a path."""
    code = re.search(r"```python\n(.*?)```", (ROOT / "README.md").read_text("utf-8"), re.S)[1]
    shutil.copy(hull / "rig.toml", tmp_path)
    shown = slice(80, 100)
    (tmp_path / "dive.mkv").mkdir()
    for picture in sorted((hull / "frames").glob("*.png"))[shown]:
        shutil.copy(picture, tmp_path / "dive.mkv")
    head, *times = (hull / "frames/times.csv").read_text().splitlines()
    (tmp_path / "dive.mkv/times.csv").write_text("\n".join([head, *times[shown]]))
    monkeypatch.chdir(tmp_path)
    made = {}
    exec(code, made)
    assert len(made["cloud"])
    assert len(made["mesh"].faces)


def test_the_scene_that_the_docs_show_is_one(tmp_path):
    from murkscan.simulate import parse_scene, read_scene

    text = (ROOT / "docs/simulate.md").read_text("utf-8")
    code = re.search(r"```toml\n(.*?)```", text, re.S)[1]
    _, _, folder = read_scene("plane")
    shutil.copy(folder / "rigs/pal.toml", tmp_path / "rig.toml")
    scene = parse_scene(code, "docs", tmp_path)
    assert (len(scene), scene.medium.attenuation, scene.navigation.rate) == (250, 3.0, 10.0)
