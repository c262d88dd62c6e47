# SPDX-License-Identifier: Apache-2.0
"""Renders in the background, threads, Ctrl-C, the end of the interpreter, forks."""

import gc
import os
import signal
import subprocess
import sys
import textwrap
import threading
import weakref

import numpy as np
import pytest
from conftest import SQUARE, TWO, sky, square_scene

import chromeball as cb

# Programs of their own find the same module, and conftest.
ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join([os.path.dirname(os.path.dirname(cb.__file__)),
                                                            os.path.dirname(__file__)])}
MANY = 1_000_000_000


def run(code):
    """Runs a program of its own, with the same module."""
    return subprocess.run([sys.executable, "-c", textwrap.dedent(code)], env=ENVIRONMENT, timeout=900,
                          capture_output=True, text=True)


def snapshot_of(session):
    while (image := session.snapshot()) is None:
        pass
    return image


def test_a_session_gives_the_bits_of_render(scene, camera, small):
    expected = cb.render(scene, cb.Probe(sky()), camera, **small).color
    session = cb.Session(scene, cb.Probe(sky()), camera, **small)
    with pytest.raises(cb.RunError, match="not been started"):
        session.wait()
    assert session.snapshot() is None
    assert np.array_equal(session.start().wait().color, expected)
    assert np.array_equal(session.snapshot().color, expected) and not session.is_running


def test_update_redoes_what_differs(scene, camera, small):
    probe = cb.Probe(sky())
    session = cb.Session(scene, probe, camera, **small)
    session.start().wait()
    assert session.work["loaded_scene"]
    session.update(camera=cb.Camera.look_at((1, 2, 2), (0, 0, 0)))
    session.start().wait()
    assert not session.work["loaded_scene"] and not session.work["prepared_lighting"]
    session.update(probe_rotation=30)
    turned = session.start().wait()
    assert not session.work["loaded_probe"] and session.work["prepared_lighting"]
    fresh = cb.Session(scene, probe, cb.Camera.look_at((1, 2, 2), (0, 0, 0)), probe_rotation=30, **small)
    assert np.array_equal(turned.color, fresh.start().wait().color)
    with pytest.raises(cb.InputError, match="unknown keyword"):
        session.update(probe_rotatoin=3)
    session.update(probe_rotation=None, camera=camera)
    assert np.array_equal(session.start().wait().color, cb.render(scene, probe, camera, **small).color)


def test_a_kept_scene_gives_the_bits_of_a_fresh_one(small):
    placed = cb.Camera.look_at((1, 2, 2), (0, 0, 0))
    probe = cb.Probe(sky())
    kept = square_scene()
    for camera, settings in ((None, {}), (None, {"size": (16, 48)}), (None, {"orbit": 30}), (placed, {"fov": 40}),
                             (None, {"fov": 40}), (placed, {}), (placed, {"orbit": 30}), (None, {"crop": "2,2,5,5"})):
        settings = {**small, **settings}
        expected = cb.render(square_scene(), probe, camera, **settings).color
        assert np.array_equal(cb.render(kept, probe, camera, **settings).color, expected), settings


def test_files_that_were_written_are_read_again(tmp_path, camera, small):
    file = tmp_path / "probe.pfm"

    def write(radiance, second):
        file.write_bytes(b"PF\n16 8\n-1\n" + np.full(8 * 16 * 3, radiance, "<f4").tobytes())
        os.utime(file, (second, second))

    write(1, second=1)
    kept = cb.Scene(probe={"file": str(file)})
    kept.add_mesh(SQUARE, TWO)
    first = cb.render(kept, None, camera, **small).color
    assert np.array_equal(cb.render(kept, None, camera, **small).color, first)
    write(3, second=2)
    assert np.allclose(cb.render(kept, None, camera, **small).color, 3 * first, rtol=1e-4)


def test_meshes_far_from_the_origin_by_their_transforms(small):
    def picture(x):
        scene = cb.Scene()
        for size, height in ((1, 0), (0.3, 0.4)):
            place = np.diag([size, size, size, 1.0])
            place[:3, 3] = (x, height, -x)
            scene.add_mesh(SQUARE, TWO, transform=place)
        return cb.render(scene, cb.Probe(sky()), cb.Camera.look_at((x, 2, 2 - x), (x, 0, -x), fov=40), **small).color

    near = picture(0)
    assert np.abs(picture(1e6 + 0.3) - near).mean() < 1e-3 * near.mean()


def test_snapshots_and_cancel(scene, camera, small):
    session = cb.Session(scene, cb.Probe(sky()), camera, **{**small, "samples": MANY})
    with session:
        first = snapshot_of(session)
        kept = first.color.copy()
        assert session.is_running and not first.is_complete and first.stats == {}
        while session.snapshot().samples < 2 * first.samples:
            pass
        assert np.array_equal(first.color, kept)
    image = session.wait()
    assert not session.is_running and not image.is_complete and image.samples >= 2 * first.samples
    session.cancel()


def test_errors_come_from_wait(scene, camera, small):
    session = cb.Session(scene, cb.Probe(sky()), camera, lens_flare=None, **small)
    session.update(camera=cb.Camera(name="Front"))
    with pytest.raises(cb.InputError, match="no camera `Front`"):
        session.start().wait()
    session.update(camera=camera)
    assert session.start().wait().is_complete


def test_threads_render_at_once_and_python_goes_on(camera, small):
    scenes = [square_scene(roughness=r) for r in (0.2, 1)]
    probe = cb.Probe(sky())
    expected = [cb.render(scene, probe, camera, **small).color for scene in scenes]
    found = [[], []]

    def work(i):
        for _ in range(5):
            found[i].append(cb.render(scenes[i], probe, camera, **small).color)
            found[1 - i].append(cb.render(scenes[1 - i], probe, camera, **small).color)

    threads = [threading.Thread(target=work, args=(i,)) for i in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for i in (0, 1):
        assert len(found[i]) == 10 and all(np.array_equal(image, expected[i]) for image in found[i])


def test_one_session_for_several_threads(scene, camera, small):
    session = cb.Session(scene, cb.Probe(sky()), camera, **{**small, "samples": MANY}).start()
    images = []
    waiting = threading.Thread(target=lambda: images.append(session.wait()))
    waiting.start()
    snapshot_of(session)
    for _ in range(20):
        session.snapshot()
        session.fraction
    session.cancel()
    waiting.join()
    assert images[0].samples > 0


def test_callbacks_come_from_another_thread_and_may_cancel(scene, camera, small):
    threads = set()

    def progress(stage, fraction):
        threads.add(threading.get_ident())
        if stage == "render" and fraction > 0:
            session._session.request_cancel()

    session = cb.Session(scene, cb.Probe(sky()), camera, progress=progress, **{**small, "samples": 10_000_000})
    assert not session.start().wait().is_complete
    assert threads and threading.get_ident() not in threads


def test_a_session_in_a_cycle_is_freed(scene, camera, small):
    class Watcher:
        def __call__(self, stage, fraction):
            pass

    watcher = Watcher()
    watcher.session = cb.Session(scene, cb.Probe(sky()), camera, progress=watcher, **{**small, "samples": MANY})
    watcher.session.start()
    gone = weakref.ref(watcher)
    del watcher
    gc.collect()
    assert gone() is None


def test_ctrl_c_ends_a_render(scene, camera, small):
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # it is ignored in background jobs
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        cb.render(scene, cb.Probe(sky()), camera, **{**small, "samples": MANY})
    timer.join()
    signal.signal(signal.SIGINT, before)
    assert cb.render(scene, cb.Probe(sky()), camera, **small).is_complete


def test_the_interpreter_ends_while_a_render_goes_on():
    done = run("""
        import conftest, chromeball as cb
        session = cb.Session(conftest.square_scene(), cb.Probe(conftest.sky()), size=(64, 64), samples=1000000000,
                             progress=lambda *p: None)
        session.start()
        while session.snapshot() is None: pass
        print("ends")
    """)
    assert (done.returncode, done.stdout, done.stderr) == (0, "ends\n", "")


def test_a_forked_child_says_why_it_cannot_render():
    done = run("""
        import os, sys, conftest, chromeball as cb
        scene, probe = conftest.square_scene(), cb.Probe(conftest.sky())
        cb.render(scene, probe, size=(8, 8), samples=2)
        child = os.fork()
        if child == 0:
            try:
                cb.render(scene, probe, size=(8, 8), samples=2)
            except cb.RunError as error:
                os._exit(7 if "spawn" in str(error) else 1)
            os._exit(2)
        sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
    """)
    assert done.returncode == 7, done.stderr


def test_a_child_that_is_forked_before_renders():
    done = run("""
        import os, sys, conftest, chromeball as cb
        child = os.fork()
        if child == 0:
            image = cb.render(conftest.square_scene(), cb.Probe(conftest.sky()), size=(8, 8), samples=2)
            os._exit(0 if image.is_complete else 1)
        sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
    """)
    assert done.returncode == 0, done.stderr
