"""What the studio refuses: strangers, foreign pages, ways out of its folder, too much."""

import asyncio
import os
import resource
from urllib.parse import quote

import httpx2
import pytest

from murkscan.errors import InputError
from murkscan.studio import make_app, serve

from .conftest import HERE, TOKEN


@pytest.mark.parametrize("path", ["/", "/api/folder", "/wrong/", "//", f"/{TOKEN[:-1]}/"])
def test_without_the_token_nothing_is_answered(ask, path):
    answer = ask.get(f"{HERE}{path}")
    assert answer.status_code == 403
    assert "token" in answer.text


@pytest.mark.parametrize("origin", ["https://elsewhere.example", "null", "http://127.0.0.1:9", ""])
def test_a_foreign_page_can_have_nothing_done(ask, origin):
    asked = {"command": "check", "values": {}}
    answer = ask.post("api/jobs", json=asked, headers={"origin": origin})
    assert answer.status_code == 403
    assert ask.put("api/upload/a.png", content=b"a", headers={"origin": origin}).status_code == 403


def test_a_name_that_was_made_to_lead_here_is_not_answered(ask):
    assert ask.get("api/folder", headers={"host": "elsewhere.example:8000"}).status_code == 403


WAYS_OUT = [
    "../secret.txt", "a/../../secret.txt", "..\\secret.txt", "/etc/passwd", "link/secret.txt",
    ".studio/.lock", "C:/secret.txt", "a\0b", "",
]  # fmt: skip


@pytest.mark.parametrize("way", WAYS_OUT)
def test_no_path_leads_out_of_the_folder(folder, ask, way):
    os.symlink(folder.parent, folder / "link")
    answer = ask.get(f"{HERE}/{TOKEN}/files/{quote(way, safe='')}")
    assert answer.status_code in (400, 404)
    assert answer.text != "secret"
    assert ask.get("api/rig", params={"name": way}).status_code == 400
    asked = {"command": "cloud", "values": {"out": "rig.toml", "export": way or "../a.ply"}}
    assert ask.post("api/command", json=asked).status_code == 400
    assert ask.put(f"api/upload/{quote(way, safe='')}.png", content=b"a").status_code in (400, 404)


@pytest.mark.parametrize(
    ("command", "values"),
    [
        ("scan", {"recording": "rig.toml", "executor": "dask"}),
        ("capture", {"source": "file:///etc/passwd", "out": "a.mkv"}),
        ("capture", {"source": "concat:/etc/passwd", "out": "a.mkv"}),
        ("simulate", {}),
        ("plan", {"rig": "rig.toml", "visibility-m": {"a": 1}}),
        ("plan", {"rig": "rig.toml", "visibility-m": "3\n--rig"}),
    ],
)
def test_only_the_studio_s_commands_and_flags_are_taken(ask, command, values):
    answer = ask.post("api/command", json={"command": command, "values": values})
    assert answer.status_code == 400
    assert "\n" not in answer.text


def test_a_value_cannot_become_a_flag(ask):
    asked = {"command": "measure section",
             "values": {"out": "rig.toml", "point-m": "--help", "normal": "-1,0,0"}}  # fmt: skip
    text = ask.post("api/command", json=asked).json()["text"]
    assert text == "murkscan measure rig.toml section --point-m=--help --normal=-1,0,0"


def test_a_name_with_a_script_comes_as_text_and_a_page_in_the_folder_as_a_stranger(folder, ask):
    name = "<script>alert(1)</script>.toml".replace("/", "-")
    (folder / name).write_text((folder / "rig.toml").read_text())
    (folder / "page.html").write_text("<script>alert(1)</script>")
    told = ask.get("api/folder")
    assert told.headers["content-type"] == "application/json"
    assert name in told.json()["found"]["rigs"]
    assert "script-src 'self'" in ask.get("").headers["content-security-policy"]
    policy = ask.get("files/page.html").headers["content-security-policy"]
    assert policy.startswith("sandbox allow-scripts")
    assert "allow-same-origin" not in policy


def test_an_upload_is_bounded_whether_its_length_is_said_or_not(folder, ask):
    def endless():
        for _ in range(100):
            yield bytes(10_000)

    said = ask.put("api/upload/a.png", content=b"", headers={"content-length": str(10**10)})
    assert said.status_code == 413
    unsaid = ask.put("api/upload/a.png", content=endless())
    assert (unsaid.status_code, unsaid.text) == (413, said.text)
    assert [path.name for path in folder.rglob("*a.png*")] == []


def test_a_question_is_bounded_too(ask):
    def endless():
        for _ in range(100):
            yield b" " * 10_000

    assert ask.post("api/jobs", content=endless()).status_code == 413
    assert ask.post("api/jobs", content=b"[" * 50_000).status_code == 400
    assert ask.post("api/jobs", content=b" " * 70_000).status_code == 413


def test_all_addresses_at_once_are_none(folder):
    with pytest.raises(InputError, match="all addresses at once"):
        serve(folder, host="0.0.0.0")


def test_an_upload_is_kept_whole_and_replaces_nothing(folder, ask):
    assert ask.put("api/upload/photos/a.png", content=b"abc").json() == {"name": "photos/a.png"}
    assert (folder / "photos/a.png").read_bytes() == b"abc"
    again = ask.put("api/upload/photos/a.png", content=b"other")
    assert again.status_code == 400
    assert "is there already" in again.text
    assert (folder / "photos/a.png").read_bytes() == b"abc"
    assert ask.put("api/upload/run.sh", content=b"abc").status_code == 400


def test_a_hundred_questions_at_once_are_answered_or_put_off_in_bounded_memory(folder):
    app = make_app(folder, TOKEN)

    async def all_at_once():
        transport = httpx2.ASGITransport(app=app)
        async with httpx2.AsyncClient(transport=transport, base_url=HERE) as client:
            one = f"/{TOKEN}/api/folder"
            return await asyncio.gather(*(client.get(one) for _ in range(100)))

    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    codes = [answer.status_code for answer in asyncio.run(all_at_once())]
    assert set(codes) <= {200, 503}
    assert codes.count(200) >= 40
    # Kilobytes; each question is small, so that nothing near this is needed.
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 100_000
