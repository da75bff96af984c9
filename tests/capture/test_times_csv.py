import pytest
from hypothesis import given
from hypothesis import strategies as st

from murkscan.errors import FormatError
from murkscan.io.times_csv import read_times, write_times

FILES = ["1.png", "2.png", "3.png"]


@given(st.lists(st.floats(-1e9, 1e9), min_size=1, max_size=20, unique=True))
def test_what_is_written_is_read(tmp_path_factory, times):
    path = tmp_path_factory.mktemp("times") / "times.csv"
    names = [f"Bild, {number}.png" for number in range(len(times))]
    write_times(path, dict(zip(names, sorted(times), strict=True)))
    assert read_times(path, names) == tuple(sorted(times))


def test_lines_may_stand_in_any_order(tmp_path):
    path = tmp_path / "times.csv"
    path.write_text("file,time_s\r\n3.png,3\r\n1.png,1\r\n\r\n2.png,2\r\n", "utf-8-sig")
    assert read_times(path, FILES) == (1.0, 2.0, 3.0)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("", "line 1 must be the header"),
        ("name,time\n", "line 1 must be the header"),
        ("file,time_s\n1.png,1\n2.png,2\n3.png,3\n4.png,4\n", "line 5: there is no picture 4.png"),
        ("file,time_s\n1.png,1\n3.png,3\n", "no line for the picture 2.png"),
        ("file,time_s\n1.png,1\n1.png,2\n", "line 3: 1.png has a time in line 2"),
        ("file,time_s\n1.png,1\n2.png,1\n3.png,3\n", "line 3: 2.png at 1 s"),
        ("file,time_s\n1.png,1\n2.png,5\n3.png,3\n", "line 4: 3.png at 3 s"),
        ("file,time_s\n1.png,soon\n", "line 2: '1.png,soon'"),
        ("file,time_s\n1.png,nan\n", "line 2"),
        ("file,time_s\n1.png\n", "line 2"),
        ("file,time_s\n1.png,1,2\n", "line 2"),
    ],
)
def test_a_wrong_file_is_refused_by_name_and_line(tmp_path, text, what):
    path = tmp_path / "times.csv"
    path.write_text(text)
    with pytest.raises(FormatError) as refusal:
        read_times(path, FILES)
    assert what in str(refusal.value)
    assert str(path) in str(refusal.value)
