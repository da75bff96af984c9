"""Who comes too fast loses his oldest, and nobody waits for ever."""

import threading

import numpy as np

from murkscan.live import Mailbox, SpreadFrames
from murkscan.types.frame import Frame


def test_a_full_mailbox_drops_the_oldest_and_counts_it():
    box = Mailbox[int](3)
    for number in range(5):
        box.put(number)
    assert box.dropped == 2
    assert [box.get(0.0) for _ in range(4)] == [2, 3, 4, None]


def test_what_is_there_when_it_closes_can_still_be_taken():
    box = Mailbox[int](3)
    box.put(1)
    box.close()
    box.put(2)
    assert not box.is_done
    assert box.get(10.0) == 1
    assert box.is_done
    assert box.get(10.0) is None


def test_a_reader_that_waits_is_woken():
    box, got = Mailbox[int](1), []
    reader = threading.Thread(target=lambda: got.append(box.get(30.0)))
    reader.start()
    box.put(7)
    reader.join(10)
    assert got == [7]


def test_frames_are_spread_over_all_of_a_dive_in_pairs_of_fields():
    spread = SpreadFrames(48)
    for index in range(10_000):
        spread.add(Frame(np.zeros((2, 2), np.uint8), index, 0.02 * index, index % 2, 2))
    kept = [frame.index for frame in spread.frames()]
    assert 24 <= len(kept) <= 48
    assert sum(index % 2 for index in kept) == len(kept) // 2
    steps = np.diff([index // 2 for index in kept[::2]])
    assert kept[0] == 0
    assert np.all(steps == steps[0])
    assert kept[-1] > 9_000
