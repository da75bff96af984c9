"""What finds the stripe while frames come, alone: without a dive around it."""

import threading
import time

import numpy as np

from murkscan.capture import ArrivedFrame
from murkscan.distribute import AbstractExecutor
from murkscan.extract import GrayGravity
from murkscan.survey.live_finder import LiveFinder
from murkscan.triangulate import RaySheet
from murkscan.types.frame import Frame

from ..scenes import air_rig


class Slow(AbstractExecutor):
    """Learns for a while, and tells whether it still does."""

    shares_memory = True

    def __init__(self):
        self.began, self.ended = threading.Event(), False

    def map(self, task, items):
        for item in items:
            self.began.set()
            time.sleep(0.3)
            self.ended = True
            yield task(item)


def test_when_the_frames_are_done_so_is_the_learning():
    learner = Slow()
    finder = LiveFinder(air_rig(), GrayGravity(), RaySheet(), laser=0, learner=learner)
    running = threading.Thread(target=finder.run)
    running.start()
    for number in range(200):
        if learner.began.is_set():
            break
        frame = Frame(np.zeros((576, 720), np.uint8), number, 0.5 * number)
        finder.frames.put(ArrivedFrame(frame, time.monotonic()))
        time.sleep(0.01)
    finder.frames.close()
    running.join(10)
    assert learner.ended
    assert not running.is_alive()
