"""What every executor promises; a new one joins the list and inherits the tests."""

import os
import signal
import sys
import time
from pathlib import Path

import pytest

from murkscan.distribute import Dask, Processes, Serial, Threads
from murkscan.errors import DeviceError, InputError, MissingDependency

EXECUTORS = [Serial(), Threads(2), Processes(2), Dask(workers=2)]


@pytest.fixture(params=EXECUTORS, ids=lambda one: type(one).__name__)
def executor(request):
    if isinstance(request.param, Dask):
        pytest.importorskip("distributed", reason="the extra [cluster] is not installed")
    return request.param


def square(number):
    time.sleep(0.01 * (number % 3))  # so that they end in another order
    return number**2


def fail(number):
    if number == 3:
        raise InputError("Number 3 is not wanted.")
    return number


def die_once(arguments):
    """Kill the process at one item, the first time that it comes."""
    number, folder = arguments
    if number == 4 and not (Path(folder) / "died").exists():
        (Path(folder) / "died").touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def die(number):
    os.kill(os.getpid(), signal.SIGKILL)
    return number


def test_results_come_in_the_order_of_the_items(executor):
    assert list(executor.map(square, range(20))) == [number**2 for number in range(20)]


def test_nothing_gives_nothing(executor):
    assert list(executor.map(square, [])) == []


def test_an_error_comes_as_it_was_raised(executor):
    results = executor.map(fail, range(10))
    assert [next(results) for _ in range(3)] == [0, 1, 2]
    with pytest.raises(InputError, match="Number 3"):
        next(results)


def test_items_are_taken_as_they_are_needed(executor):
    taken = []

    def items():
        for number in range(100):
            taken.append(number)
            yield number

    results = executor.map(square, items())
    next(results)
    assert len(taken) < 20
    results.close()


@pytest.mark.skipif(sys.platform != "linux", reason="kills a process by POSIX")
@pytest.mark.parametrize("executor", [Processes(2), Dask(workers=2)], ids=["Processes", "Dask"])
def test_a_killed_worker_costs_its_tasks_and_nothing_else(executor, tmp_path):
    if isinstance(executor, Dask):
        pytest.importorskip("distributed", reason="the extra [cluster] is not installed")
    items = [(number, str(tmp_path)) for number in range(12)]
    assert list(executor.map(die_once, items)) == list(range(12))
    assert (tmp_path / "died").exists()


@pytest.mark.skipif(sys.platform != "linux", reason="kills a process by POSIX")
def test_a_task_that_kills_every_worker_is_given_up():
    with pytest.raises(DeviceError, match="died"):
        list(Processes(1).map(die, [1]))


@pytest.mark.parametrize("make", [Threads, Processes])
@pytest.mark.parametrize("workers", [0, -1])
def test_no_workers_are_refused(make, workers):
    with pytest.raises(InputError, match="at least 1 worker"):
        make(workers)


def test_a_cluster_has_its_own_workers():
    with pytest.raises(InputError, match="has its own workers"):
        Dask("tcp://127.0.0.1:1", workers=2)


def test_a_scheduler_that_does_not_answer_is_told_with_the_cure(monkeypatch):
    pytest.importorskip("distributed", reason="the extra [cluster] is not installed")
    monkeypatch.setattr("murkscan.distribute.dask._PATIENCE", 1)
    with pytest.raises(DeviceError, match="dask scheduler"):
        list(Dask("tcp://127.0.0.1:9").map(square, [1]))


def test_without_the_extra_the_install_line_is_said():
    """A module that is not there stands for an extra that is not installed."""
    import subprocess

    code = (
        "import sys; sys.modules['distributed'] = None\n"
        "from murkscan.distribute import Dask\n"
        "try: list(Dask().map(abs, [1]))\n"
        "except ImportError as error: print(error)\n"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert 'pip install "murkscan[cluster]"' in said.stdout
    assert issubclass(MissingDependency, ImportError)


def tell_niceness(_):
    return os.getpriority(os.PRIO_PROCESS, 0)


@pytest.mark.skipif(not hasattr(os, "getpriority"), reason="the system has no niceness")
def test_processes_give_way_as_much_as_they_are_told_to():
    here = tell_niceness(None)
    assert list(Processes(1, niceness=3).map(tell_niceness, [None])) == [min(here + 3, 19)]
