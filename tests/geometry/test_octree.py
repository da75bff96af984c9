"""The octree of a cloud that is larger than memory."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from murkscan.geometry.octree import CellCounter, Octree, interleave, part_key


@given(st.lists(st.tuples(*[st.integers(0, 2**20 - 1)] * 3), min_size=1, max_size=50))
def test_keys_of_cells_part_into_the_cells(cells):
    cells = np.array(cells)
    keys = interleave(cells)
    np.testing.assert_array_equal(part_key(keys), cells)
    np.testing.assert_array_equal(part_key(keys >> 3), cells >> 1)


def counted(cells):
    counter = CellCounter()
    for part in np.array_split(interleave(cells), 7):
        counter.add(part)
    return counter.counted()


def test_every_point_stays_in_a_node_above_its_cell_and_nodes_hold_about_the_usual_number():
    random = np.random.default_rng(0)
    cells = np.stack([*random.integers(0, 256, (2, 100_000)), np.full(100_000, 7)], axis=1)
    tree = Octree.plan(*counted(cells), 8, usual=2000)
    node = tree.assign(interleave(cells), random)
    levels, keys = tree.levels(), np.concatenate(tree.keys)
    np.testing.assert_array_equal(
        keys[node], interleave(cells) >> (3 * (tree.depth - levels[node]))
    )
    counts = np.bincount(node, minlength=len(keys))
    # A node's number is binomial: 6 of its deviations.
    assert (np.abs(counts - tree.expected) <= 6 * np.sqrt(tree.expected)).all()
    assert counts.max() < 2 * 2000 * 1.2
    assert counts[0] > 1700


def test_every_node_has_its_parent():
    random = np.random.default_rng(1)
    cells = np.abs(random.normal(0, 40, (50_000, 3))).astype(int).clip(0, 255)
    tree = Octree.plan(*counted(cells), 8, usual=500)
    for above, below in zip(tree.keys[:-1], tree.keys[1:], strict=True):
        assert np.isin(below >> 3, above).all()


def test_a_cell_that_is_too_full_keeps_all_at_the_deepest_level():
    cells = np.zeros((10_000, 3), int)
    tree = Octree.plan(*counted(cells), 3, usual=100)
    assert len(np.concatenate(tree.keys)) == 4
    assert tree.expected[-1] == 10_000 - 300
