"""A program written in joints and in Cartesian form is the same program when it is read."""

import numpy as np
import pytest
from random_programs import Deviation, note_cartesian_form, note_joint_form, random_program


def written_and_read(count, seed):
    rng = np.random.default_rng(seed)
    worst = Deviation()
    for _ in range(count):
        asked = random_program(rng)
        note_joint_form(asked, worst)
        note_cartesian_form(asked, worst)
    assert worst.joints < 1e-3
    assert worst.place < 0.002
    assert worst.angle < 0.002
    assert worst.solved_joints < 0.1
    assert worst.moves >= count
    return worst


def test_random_programs_come_back_from_both_forms():
    written_and_read(300, seed=7)


@pytest.mark.long
def test_ten_thousand_random_programs_come_back_from_both_forms():
    print(written_and_read(10_000, seed=11))
