"""The report of merged passes says how each way was corrected, or why not."""

from murkscan.report import MergedSummary, ModelSize, ReportedPass, merged_as_html, merged_as_json


def reported(name, correction):
    return ReportedPass(
        name=name, path=f"../{name}", points=10, frames=(0, 4), first_frame=0, words="stays",
        shift=None, turn=None, overlap=None, rms=None, laid_on=(), rig=None,
        correction=correction, corrected=2.5e-3 if correction else None,
    )  # fmt: skip


def summary(correction=(), remarks=()):
    return MergedSummary(
        name="hull", passes=[reported("dive1", correction)], pairs=[], rigs=[],
        model=ModelSize(10, 0, 3, 1, None), trust=None, settings={}, versions={}, durations={},
        commands=[], pictures=[], unstated=[], remarks=remarks,
    )  # fmt: skip


def test_a_corrected_way_is_told_in_both():
    one = summary(("corrected along its way by 2.5 mm", "the clock is 1 s late"))
    told = merged_as_json(one)["merged"][0]
    assert told["corrected_mm"] == 2.5
    assert told["correction"] == ["corrected along its way by 2.5 mm", "the clock is 1 s late"]
    assert "corrected along its way by 2.5 mm; the clock is 1 s late" in merged_as_html(one)


def test_why_passes_stay_rigid_is_told_in_both():
    one = summary(remarks=("the passes were moved as rigid bodies: nobody knows",))
    assert merged_as_json(one)["remarks"] == [*one.remarks]
    assert merged_as_json(one)["merged"][0]["corrected_mm"] is None
    assert "The passes were moved as rigid bodies: nobody knows." in merged_as_html(one)
    assert "Ways of the passes" not in merged_as_html(summary())
