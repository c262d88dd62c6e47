# SPDX-License-Identifier: Apache-2.0
"""The module as a guest in its process; types; the programs of its documentation."""

import pathlib
import re
import subprocess
import sys

import pytest
from conftest import PROJECT
from test_session import ENVIRONMENT, run

import chromeball as cb

PACKAGE = pathlib.Path(cb.__file__).parent


def test_import_loads_neither_numpy_nor_what_others_bring_along():
    done = run("""
        import sys
        def libraries(): return {line.split("/")[-1].strip() for line in open("/proc/self/maps") if ".so" in line}
        before = libraries()
        import chromeball
        print(*(name for name in sys.modules if name.startswith("numpy")))
        print(*libraries() - before)
    """)
    modules, libraries = done.stdout.split("\n")[:2]
    assert modules == ""
    assert not re.search(r"blas|lapack|gomp|iomp|mkl|opencv|OpenImageIO|libpython|Qt|avcodec", libraries)
    assert "libembree" in libraries


def test_the_module_exports_its_own_function_alone():
    core = next(PACKAGE.glob("_core*.so"))
    try:
        names = subprocess.run(["nm", "-D", "--defined-only", core], capture_output=True, text=True, check=True).stdout
    except FileNotFoundError:
        pytest.skip("nm is absent")
    exported = [line.split()[-1] for line in names.splitlines()]
    assert exported == ["PyInit__core"]


def test_types(tmp_path):
    pytest.importorskip("mypy")
    (tmp_path / "user.py").write_text(
        "import chromeball as cb\n"
        "image: cb.Result = cb.render(cb.load('a.glb'), cb.Probe('b.exr').rotated(3), samples=4, layers=['depth'])\n"
        "image.color.mean()\n"
    )
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache"), "user.py",
                           str(PACKAGE)], env=ENVIRONMENT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_everything_public_is_explained():
    for name in cb.__all__:
        found = getattr(cb, name)
        if name != "__version__":
            assert found.__doc__, name


PROGRAMS = re.findall(r"```python\n(.*?)```", (PROJECT / "docs" / "python.md").read_text(), re.DOTALL)


@pytest.mark.parametrize("program", PROGRAMS, ids=range(len(PROGRAMS)))
def test_the_programs_of_the_documentation_run(program, tmp_path):
    for folder in ("scenes", "probes"):
        (tmp_path / folder).symlink_to(PROJECT / folder)
    done = run(program)
    assert (done.returncode, done.stderr) == (0, "")
