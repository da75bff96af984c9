"""The page as users meet it: in a browser, from a file, by mouse and keys."""

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.cloud import merge_profiles
from murkscan.mesh import GridMesh
from murkscan.types.frame_times import FrameTimes
from murkscan.view import Layer, fit_shift_field, model_of_points, model_of_scan, render_viewer

from ..scans import plane, scan, scan_cloud, sphere, step
from .browser import chromium, open_page, picture, rest

HOSTILE = "</script><script>window.broken=1</script><img src=x onerror='window.broken=1'>"
SIGMA = 2e-4


def scanned(surface, name="scan", **settings):
    """Give a scan's model, and the cloud that it shows."""
    cloud = scan_cloud(surface, **settings)
    _, trajectory = scan(surface, **settings)
    times = np.unique(cloud.frame)
    model = model_of_scan(
        name,
        cloud,
        mesh=GridMesh().mesh(cloud),
        trajectory=trajectory,
        frames=FrameTimes(times.astype(np.uint32), times * 0.04),
    )
    return model, cloud


@pytest.fixture(scope="module")
def browser():
    with chromium() as started:
        yield started


@pytest.fixture(scope="module")
def steps():
    return scanned(step, spacing=2e-3, noise=SIGMA)


@pytest.fixture(scope="module")
def turned():
    """A plane scanned by a camera that looks askew, whose points share errors that are known."""
    profile, trajectory = scan(plane, spacing=4e-3)
    askew = Rotation.from_rotvec([0.4, -0.7, 0.2])
    quaternions = np.tile(askew.as_quat(scalar_first=True), (2, 1))
    # At its end the way is 2 mm too long, and looks aside by a milliradian.
    errors = np.zeros((2, 6, 2))
    errors[1, 0, 0], errors[1, 4, 1] = 2e-3, 1e-3
    trajectory = replace(trajectory, quaternions=quaternions, errors=errors)
    cloud = replace(
        merge_profiles(profile, trajectory, axes=("x",)),
        sigma=np.full(len(profile), 1e-6, np.float32),
    )
    # All is a hundredth too large, and what is far is pushed to the right.
    shifts = np.stack([1e-2 * profile.points, profile.points[:, [2, 0, 0]] * [2e-2, 0, 0]], axis=2)
    field = fit_shift_field(profile.points, shifts)
    times = np.unique(cloud.frame)
    frames = FrameTimes(times.astype(np.uint32), times * 0.04)
    model = model_of_scan("turned", cloud, trajectory=trajectory, frames=frames, shift_field=field)
    by_rig = np.einsum("ij,njk->nik", askew.as_matrix(), shifts)
    by_way = trajectory.shifts(cloud.points, profile.time)
    return model, np.concatenate([by_rig, by_way], axis=2)


@pytest.fixture(scope="module")
def opened(browser, steps, turned, tmp_path_factory):
    """A page with a step scanned, a ball, which a hostile name has been given, and a plane."""
    ball, _ = scanned(sphere, HOSTILE, spacing=2e-3)
    file = tmp_path_factory.mktemp("page") / "a page?#.html"
    file.write_text(render_viewer([steps[0], ball, turned[0]], title=HOSTILE), "utf-8")
    return open_page(browser, file)


@pytest.fixture
def page(opened):
    """The same page as it was opened, seen from the front; what is done there causes no error."""
    page, faults = opened
    page.evaluate("murkscan.update({scan: 0, measures: [], measuring: false, layer: 'depth'})")
    for key in ("r", "2"):
        page.keyboard.press(key)
    rest(page)
    yield page
    assert faults == []


def drawn(page):
    """Tell which pixels of the stage differ from its bare lower right part, without the writing."""
    image = picture(page)[:, : page.evaluate("murkscan.stage.width")].astype(int)
    off = np.abs(image - image[300, -8]).max(axis=2) > 24
    off[:84], off[-72:], off[:, :110], off[:, -4:] = False, False, False, False
    return off


def redrawn(page):
    """Give the picture after it has been drawn anew, as a model at rest is."""
    page.evaluate("murkscan.stage.invalidate()")
    rest(page)
    return picture(page).astype(int)


def click(page, point):
    """Click where the page shows a point of the world [m]."""
    x, y = page.evaluate(
        "p => murkscan.stage.project(p.map((x, k) => x - murkscan.model.centre[k]))", point.tolist()
    )[:2]
    page.mouse.click(x, y)


def test_the_page_opens_without_an_error_and_then_rests(opened, page):
    assert opened[1] == []
    frames = page.evaluate("murkscan.stage.canvas.dataset.frames")
    page.wait_for_timeout(300)
    assert page.evaluate("murkscan.stage.canvas.dataset.frames") == frames


def test_the_model_covers_what_its_size_and_the_scale_say(page):
    page.keyboard.press("b")
    page.keyboard.press("2")
    rest(page)
    vertices = page.evaluate("Array.from(murkscan.model.positions)")
    right, down, _ = np.array(vertices).reshape(-1, 3).T * page.evaluate("murkscan.stage.scale")
    # The ball's visible cap is nearly a disc of the points' extent, whose rim is a spacing wide.
    area = np.pi / 4 * np.ptp(right) * np.ptp(down)
    assert drawn(page).sum() == pytest.approx(area, rel=0.1)


def test_the_scale_bar_is_as_long_as_it_says(page):
    said = page.locator("#scale span").inner_text()
    width = page.locator("#scale i").bounding_box()["width"]
    per_metre = page.evaluate("murkscan.stage.scale")
    assert width / per_metre * 1e3 == pytest.approx(float(said.removesuffix(" mm")), rel=1e-3)


def test_positions_arrive_as_finely_as_the_page_says(page, steps):
    model, _ = steps
    shown = np.array(page.evaluate("Array.from(murkscan.model.positions)")).reshape(-1, 3)
    centre, grid = page.evaluate("[murkscan.model.centre, murkscan.model.grid.step]")
    # Half a step, and single precision.
    off = np.abs(shown + centre - model.vertices).max()
    assert off <= grid / 2 + 1e-7
    assert grid / 2 <= min(2e-5, 0.1 * SIGMA) * (1 + 1e-9)


def test_the_surface_arrives_as_finely_and_apart_from_its_points(page, steps):
    model, _ = steps
    moved = np.abs(model.surface - model.vertices).max()
    assert moved > 1e-5
    centre = np.array(page.evaluate("murkscan.model.centre"))
    shown = np.array(page.evaluate("Array.from(murkscan.model.surface)")).reshape(-1, 3) + centre
    allowed = page.evaluate("murkscan.model.grid.step") / 2
    # Single precision of half a metre is 3e-8 m, for the position and for the sum.
    assert np.abs(shown - model.surface).max() <= allowed + 1e-7


def test_a_known_length_is_measured_right_and_its_doubt_follows_sigma(page, steps):
    _, cloud = steps
    # One point on each of the two planes, 30 mm apart in depth.
    off = [np.abs(cloud.points - place).sum(axis=1) for place in ((0, -0.02, 0.47), (0, 0.02, 0.5))]
    a, b = (int(distance.argmin()) for distance in off)
    page.keyboard.press("m")
    click(page, cloud.points[a])
    click(page, cloud.points[b])
    rest(page)
    assert page.evaluate("murkscan.state.measures.map(m => [m.first, m.second])") == [[a, b]]
    span = cloud.points[b] - cloud.points[a]
    said, doubt = re.findall(r"[\d.]+", page.locator("#labels span").inner_text())
    # Two roundings of at most 0.02 mm on each axis, and the last digit.
    assert float(said) == pytest.approx(1e3 * np.linalg.norm(span), abs=0.05)
    camera = np.array([cloud.frame[[a, b]] * 2e-3 - 0.06, [0, 0], [0, 0]]).T
    rays = cloud.points[[a, b]] - camera
    along = rays @ span / np.linalg.norm(span) / np.linalg.norm(rays, axis=1)
    expected = 1.96e3 * np.sqrt(np.sum((SIGMA * along) ** 2))
    # The rounding adds a per cent at most; two digits are shown.
    assert float(doubt) == pytest.approx(expected, rel=0.02, abs=0.006)


def test_what_the_points_share_counts_as_far_as_it_stretches_a_length(page, turned):
    model, shifts = turned
    ends = [20, len(shifts) - 40]
    page.evaluate("ends => (murkscan.update({scan: 2}), murkscan.measure(...ends))", ends)
    rest(page)
    span = np.diff(model.vertices[ends], axis=0)[0]
    along = span / np.linalg.norm(span)
    expected = 1.96e3 * np.linalg.norm(along @ (shifts[ends[1]] - shifts[ends[0]]))
    said = page.locator(".measures").inner_text()
    shared = float(re.search(r"part of calibration and motion in it: ± ([\d.]+) mm", said)[1])
    # The last of two digits.
    assert expected > 0.5
    assert shared == pytest.approx(expected, abs=0.006)


def test_what_is_measured_can_be_copied_as_the_command_that_measures_it(page, steps):
    ends = [20, 3000]
    page.evaluate("ends => murkscan.measure(...ends)", ends)
    words = page.locator(".measures .copy").get_attribute("title").split()
    assert words[:4] == ["murkscan", "measure", "OUT", "distance"]
    named = dict(zip(words[4::2], words[5::2], strict=True))
    places = [[float(x) for x in named[flag].split(",")] for flag in ("--from-m", "--to-m")]
    np.testing.assert_allclose(places, steps[1].points[ends], atol=3e-5)  # the page's rounding
    page.keyboard.press("c")
    words = page.locator("#tool-cut .copy").get_attribute("title").split()
    point, normal = ([float(x) for x in words[k].split(",")] for k in (5, 7))
    places = page.evaluate("Array.from(murkscan.section.places.slice(0, 3))")
    centre = page.evaluate("murkscan.model.centre")
    assert np.dot(np.subtract(np.add(places, centre), point), normal) == pytest.approx(0, abs=2e-5)


def test_places_are_in_metres_and_lengths_in_millimetres(page, steps):
    page.evaluate("murkscan.update({read: 20})")
    said = page.locator("#reading").inner_text()
    place = [float(f"{'-' if sign else ''}{number}") for sign, number in
             re.findall(r"[xyz] (−?)([\d.]+) m\b", said)]  # fmt: skip
    np.testing.assert_allclose(place, steps[1].points[20], atol=3e-5)
    page.evaluate("murkscan.update({read: null})")


def test_escape_stops_measuring_and_keeps_what_was_measured(page, steps):
    page.keyboard.press("m")
    for place in (0, -1):
        click(page, steps[1].points[place])
    page.keyboard.press("Escape")
    assert not page.evaluate("murkscan.state.measuring")
    assert page.evaluate("murkscan.state.measures.length") == 1


def test_a_cut_takes_a_half_away_and_draws_the_section(page):
    before = drawn(page).sum()
    page.keyboard.press("c")
    rest(page)
    assert drawn(page).sum() == pytest.approx(before / 2, rel=0.15)
    places = page.locator("#tool-cut svg path").first.get_attribute("d")
    ends = np.array(re.findall(r"[-\d.]+", places), float).reshape(-1, 2)
    # Two level lines, 30 mm apart; ± 4.5 sigma of noise on either.
    assert np.ptp(ends, axis=0).min() == pytest.approx(30, abs=9e3 * SIGMA)
    orange = np.abs(picture(page).astype(int) - [0xE0, 0x56, 0x1B]).max(axis=2) < 40
    assert orange.sum() > 200


def test_the_other_side_of_a_cut_is_the_other_half(page):
    whole = drawn(page)
    page.keyboard.press("c")
    rest(page)
    one = drawn(page)
    page.get_by_role("button", name="Other side").click()
    rest(page)
    other = drawn(page)
    # The section's own line, 3 px wide, is in both.
    assert (one & other).mean(axis=0).max() > 0
    assert (one & other).sum() < 0.05 * whole.sum()
    assert (whole & ~(one | other)).sum() < 0.01 * whole.sum()


def test_playing_ends_with_the_whole_scan_and_then_rests(page):
    whole = drawn(page).sum()
    page.evaluate("murkscan.update({profile: 10})")
    rest(page)
    assert 0 < drawn(page).sum() < 0.6 * whole
    page.evaluate("murkscan.update({profile: murkscan.model.times.length - 3})")
    page.keyboard.press("p")
    page.wait_for_function("() => !murkscan.state.playing", timeout=10_000)
    rest(page)
    assert drawn(page).sum() == whole


@pytest.mark.parametrize("key", ["ArrowLeft", "ArrowUp", "+", "1", "6"])
def test_keys_turn_zoom_and_look_from_all_sides(page, key):
    before = drawn(page)
    page.keyboard.press(key)
    rest(page)
    after = drawn(page)
    assert after.any()
    assert (before != after).sum() > 50


def test_a_drag_turns_the_model_and_r_brings_it_back(page):
    page.keyboard.press("r")
    rest(page)
    before = drawn(page)
    page.mouse.move(350, 300)
    page.mouse.down()
    page.mouse.move(450, 330, steps=4)
    page.mouse.up()
    rest(page)
    assert np.any(drawn(page) != before)
    page.keyboard.press("r")
    rest(page)
    np.testing.assert_array_equal(drawn(page), before)


def test_reading_and_measuring_need_no_new_picture_of_the_model(page, steps):
    _, cloud = steps
    frames = page.evaluate("murkscan.stage.canvas.dataset.frames")
    click(page, cloud.points[len(cloud) // 2])
    assert page.locator("#reading").is_visible()
    page.keyboard.press("m")
    assert page.locator("#reading").is_hidden()
    for number in (len(cloud) // 3, len(cloud) // 2):
        click(page, cloud.points[number])
    assert page.locator("#labels span").count() == 1
    rest(page)
    assert page.evaluate("murkscan.stage.canvas.dataset.frames") == frames


@pytest.fixture(scope="module")
def phone(browser, steps, tmp_path_factory):
    """The page on a phone, and a way to put fingers on it."""
    file = tmp_path_factory.mktemp("phone") / "index.html"
    file.write_text(render_viewer([steps[0]], title="step"), "utf-8")
    page, faults = open_page(browser, file, size=(390, 780), has_touch=True, is_mobile=True)
    session = page.context.new_cdp_session(page)

    def drag(*ways):
        """Move fingers, each from one place to another [px]."""
        for kind, shares in (
            ("touchStart", [0.0]),
            ("touchMove", [0.25, 0.5, 0.75, 1.0]),
            ("touchEnd", [None]),
        ):
            for share in shares:
                places = [
                    {"x": x + (share or 0) * (u - x), "y": y + (share or 0) * (v - y), "id": k}
                    for k, ((x, y), (u, v)) in enumerate(ways)
                ]
                touches = [] if share is None else places
                session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": touches})
        rest(page)

    yield page, drag
    assert faults == []
    page.close()


def test_one_finger_turns_and_two_zoom(phone):
    page, drag = phone
    where = "[...murkscan.stage.camera.position, murkscan.stage.camera.zoom]"
    *before, zoom = page.evaluate(where)
    drag(((200, 350), (280, 380)))
    *after, same = page.evaluate(where)
    assert np.linalg.norm(np.subtract(after, before)) > 0.1 * np.linalg.norm(before)
    assert same == zoom
    drag(((180, 350), (120, 350)), ((220, 350), (280, 350)))
    # Fingers four times as far apart: the controls begin to count at their first step.
    assert 2 < page.evaluate(where)[-1] / zoom <= 4.1


def test_a_surface_finer_than_the_pixels_is_drawn_with_fewer_triangles(browser, tmp_path):
    count = 300
    y, x = (axis.ravel() for axis in np.mgrid[0 : 0.1 : count * 1j, 0 : 0.1 : count * 1j])
    points = np.stack([x, y, 0.5 + 0.01 * np.sin(60 * x)], axis=1)
    a = np.arange(count**2).reshape(count, count)
    a, b, c, d = (part.ravel() for part in (a[:-1, :-1], a[:-1, 1:], a[1:, :-1], a[1:, 1:]))
    faces = np.concatenate([np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)])
    file = tmp_path / "index.html"
    file.write_text(render_viewer([model_of_points("bed", points, faces=faces)], title="bed"))
    page, faults = open_page(browser, file)
    assert page.evaluate("murkscan.stage.drawings[0].coarse") is None
    page.evaluate("murkscan.stage.zoomBy(1 / 6)")
    rest(page)
    few = redrawn(page)
    left = page.evaluate("murkscan.stage.drawings[0].coarse.geometry.index.count / 3")
    # Cells of three spacings hold about nine points, so about a ninth is left.
    assert len(faces) / 12 < left < len(faces) / 6
    assert not page.evaluate("murkscan.stage.drawings[0].surface.visible")
    page.evaluate("murkscan.stage.drawings[0].coarse.removeFromParent()")
    page.evaluate("Object.assign(murkscan.stage.drawings[0], {prepare() {}, coarse: null})")
    many = redrawn(page)
    assert page.evaluate("murkscan.stage.drawings[0].surface.visible")
    drawn = np.abs(many - many[300, -330]).max(axis=2) > 24
    assert drawn.sum() > 1000
    # Places move by less than a pixel: only the rim and steep colours may change.
    assert (np.abs(few - many).max(axis=2) > 24).sum() < 0.1 * drawn.sum()
    assert faults == []
    page.close()


def test_on_a_phone_a_tool_opens_at_a_tap_and_leaves_the_model_in_sight(phone):
    page, _ = phone
    page.locator("#panel nav button", has_text="Cut").tap()
    page.locator("#tool-cut button").first.tap()
    rest(page)
    assert page.locator("#tool-cut svg").is_visible()
    assert page.locator("#stage").bounding_box()["height"] > 780 / 3
    # Nothing is wider than the phone.
    assert page.evaluate("document.documentElement.scrollWidth") == 390


def test_colours_follow_the_chosen_layer(page):
    page.locator("#tool-show select").select_option("plain")
    rest(page)
    image = picture(page)[drawn_rows(page)]
    assert np.ptp(image.astype(int), axis=1).max() < 60
    page.locator("#tool-show select").select_option("depth")
    rest(page)
    assert np.ptp(picture(page)[drawn_rows(page)].astype(int), axis=1).max() > 100
    assert "depth [mm]" in page.locator("#legend").inner_text()


def drawn_rows(page):
    """Pixels of the model in the middle of the stage."""
    mask = np.zeros(picture(page).shape[:2], bool)
    mask[150:500, 130:600] = drawn(page)[150:500, 130:600]
    return mask


def test_what_is_rounded_stands_under_about(page):
    page.keyboard.press("?")
    said = page.locator("#help").inner_text()
    page.keyboard.press("Escape")
    assert re.search(r"Places are rounded by (less than )?0\.\d{3} mm", said[said.index("About") :])
    assert "rounded" not in page.locator("#about").inner_text()


def test_another_scan_is_one_key_away(page):
    name = page.locator("#about").inner_text()
    page.keyboard.press("b")
    rest(page)
    assert page.locator("#about").inner_text() != name
    assert drawn(page).any()


def test_a_hostile_name_is_only_a_name(page):
    assert page.locator("h1").inner_text() == HOSTILE
    assert page.evaluate("window.broken") is None


@pytest.mark.parametrize(("scheme", "is_dark"), [("light", False), ("dark", True)])
def test_the_page_follows_the_system_s_theme_and_t_changes_it(browser, tmp_path, scheme, is_dark):
    points = np.stack(np.meshgrid(*3 * [np.linspace(0, 0.1, 9)]), axis=-1).reshape(-1, 3)
    layer = Layer("deviation", points[:, 0] * 1e3 - 50, "mm", "coolwarm", is_signed=True)
    file = tmp_path / "index.html"
    file.write_text(render_viewer([model_of_points("cube", points, layers=[layer])], title="cube"))
    page, faults = open_page(browser, file, scheme=scheme)
    first = picture(page)
    page.keyboard.press("t")
    rest(page)
    second = picture(page)
    # Of the stage and of the panel: grey levels of their backgrounds.
    for row, column in ((320, 600), (-8, -8)):
        levels = first[row, column].mean(), second[row, column].mean()
        assert (levels[0] < 50, levels[1] > 200) == (is_dark, is_dark)
    # Zero is in the middle of the colours.
    low, high = page.evaluate("murkscan.range")
    assert low == -high
    assert faults == []
    page.close()


def test_one_profile_is_shown_as_points_and_says_so(browser, steps, tmp_path):
    _, cloud = steps
    model = model_of_scan("one", cloud[cloud.frame == 30])
    file = tmp_path / "index.html"
    file.write_text(render_viewer([model], title="one"))
    page, faults = open_page(browser, file, size=(390, 844))
    page.get_by_role("button", name="Show", exact=True).click()
    assert "Only one profile" in page.locator("#tool-show").inner_text()
    page.get_by_role("button", name="Path and time").click()
    assert "nothing to play" in page.locator("#tool-path").inner_text()
    page.keyboard.press("p")
    assert faults == []
    page.close()
