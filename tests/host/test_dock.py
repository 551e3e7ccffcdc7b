"""DockGeometry: the default dock, and dock files that are wrong."""

from importlib import resources
from pathlib import Path

import numpy as np
import pytest

from chromadock.dock import DockGeometry
from chromadock.errors import ChromadockError

REPORTS = Path(__file__).resolve().parents[3] / "shared" / "data" / "reports" / "docks"
THREE = {"a": "[0, 0, 0]", "b": "[0.5, 0, 0]", "c": "[0, 0.25, 0.1]"}


def dock_text(markers):
    return "\n".join(f'[[marker]]\nname = "{n}"\nposition = {p}' for n, p in markers)


@pytest.fixture
def load(tmp_path):
    """Write a dock file and load it."""

    def load_text(text):
        path = tmp_path / "dock.toml"
        path.write_text(text)
        return DockGeometry.from_toml(path)

    return load_text


def test_the_default_dock_is_a_centred_rectangle_of_0890_by_0127_metres():
    dock = DockGeometry.default()
    assert dock.names == ("top_left", "top_right", "bottom_left", "bottom_right")
    assert dock.points.dtype == np.float64
    assert np.allclose(np.ptp(dock.points, axis=0), (0.890, 0.127, 0))
    assert np.allclose(dock.points.mean(axis=0), 0)
    where = dict(zip(dock.names, dock.points, strict=True))
    # x right and y down, as the vehicle sees it.
    assert where["top_left"][0] < 0
    assert where["top_left"][1] < 0
    assert where["bottom_right"][0] > 0
    assert where["bottom_right"][1] > 0


def test_the_packaged_file_is_an_example_that_loads(load):
    text = resources.files("chromadock").joinpath("default_dock.toml").read_text()
    assert np.array_equal(load(text).points, DockGeometry.default().points)


def test_a_dock_file_may_have_the_colour_of_its_lamps(load):
    assert load(dock_text(THREE.items())).colour is None
    assert load("colour = '#0000ff'\n" + dock_text(THREE.items())).colour == "#0000ff"


def test_the_packaged_files_colour_is_an_example_that_loads(load):
    text = resources.files("chromadock").joinpath("default_dock.toml").read_text()
    assert load(text.replace("# colour =", "colour =")).colour == "#0000FF"


def test_three_markers_out_of_plane_and_whole_numbers_are_a_dock(load):
    dock = load(dock_text(THREE.items()))
    assert dock.names == ("a", "b", "c")
    assert dock.points.tolist() == [[0, 0, 0], [0.5, 0, 0], [0, 0.25, 0.1]]


@pytest.mark.parametrize(
    ("markers", "says"),
    [
        ([], "0 markers"),
        ([("a", "[0, 0, 0]"), ("b", "[1, 0, 0]")], "2 markers: a pose needs at least 3"),
        ([*THREE.items(), ("b", "[1, 1, 0]")], "the name b is used 2 times"),
        ([*THREE.items(), ("d", "[nan, 1, 0]")], "marker d has a position that is not finite"),
        ([*THREE.items(), ("d", "[0, inf, 0]")], "marker d has a position that is not finite"),
        ([*THREE.items(), ("d", "[0, 0, 0]")], "markers a and d are at the same place"),
        (
            [*THREE.items(), ("d", "[0, 445, 0]")],
            "up to 445 m apart: if these are millimetres, divide",
        ),
        ([*THREE.items(), ("d", "[0, 44.5, 0]")], "if these are centimetres, divide all by 100"),
        (
            [*THREE.items(), ("d", "[0, 4450, 0]")],
            "marker d is 4450 m from the origin: give metres",
        ),
        ([*THREE.items(), ("d", "[0, 1]")], "marker 4: position must be three numbers"),
        ([*THREE.items(), ("d", '[0, 1, "x"]')], "marker 4: position must be three numbers"),
        ([*THREE.items(), ("d", "true")], "marker 4: position must be three numbers"),
        ([*THREE.items(), ("", "[0, 1, 0]")], "marker 4: name is ''"),
        (
            [("a", "[0, 0, 0]"), ("b", "[0.5, 0, 0]"), ("c", "[1, 0, 0]")],
            "all markers lie on one line",
        ),
    ],
)
def test_markers_that_make_no_dock_are_refused_in_one_line(load, markers, says):
    with pytest.raises(ChromadockError) as raised:
        load(dock_text(markers))
    line = str(raised.value)
    assert "dock.toml: " in line
    assert says in line
    assert "\n" not in line


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[[marker]\n", "not valid TOML"),
        ("units = 'm'\n" + dock_text(THREE.items()), "unknown key units"),
        (
            dock_text(THREE.items()) + "\ncolour = '#FF0000'",
            "unknown key marker 3: colour: write it once, above the first [[marker]]",
        ),
        ("colour = 'red'\n" + dock_text(THREE.items()), "colour is 'red': give \"#RRGGBB\""),
        ("colour = 255\n" + dock_text(THREE.items()), 'colour is 255: give "#RRGGBB"'),
        (
            "color = 'white'\n" + dock_text(THREE.items()),
            "color: only colour, largest_range_m, confirmed",
        ),
        ("confirmed = 1\n" + dock_text(THREE.items()), "confirmed is 1: give true or false"),
        (
            dock_text(THREE.items()) + "\nconfirmed = true",
            "unknown key marker 3: confirmed: write it once, above the first [[marker]]",
        ),
        ("[[marker]]\nposition = [0, 0, 0]", "marker 1: name is missing"),
        ("[[marker]]\nname = 'a'", "marker 1: position is missing"),
        ("[[marker]]\nname = 7\nposition = [0, 0, 0]", "marker 1: name is 7"),
        ("marker = 3", "marker must be one or more [[marker]]"),
    ],
)
def test_a_file_of_another_layout_is_refused_in_one_line(load, text, says):
    with pytest.raises(ChromadockError) as raised:
        load(text)
    line = str(raised.value)
    assert says in line
    assert "\n" not in line


ROS = np.array([[0, 0, 1.0], [-1, 0, 0], [0, -1, 0]])
Z_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
"""From the dock's axes to ROS's, and to x right, y forward, z up."""

SHAPES = {
    "rectangle": DockGeometry.default().points,
    "five": np.vstack([DockGeometry.default().points, (0, 0, -0.3)]),
    "square": np.array([(x, y, 0) for x in (-0.4, 0.4) for y in (-0.4, 0.4)]),
    "ring": np.array([(np.cos(a), np.sin(a), 0) for a in np.linspace(0, 6, 8)]),
    "three": np.array([(0.5, 0, 0), (0, 0.25, 0), (-0.2, -0.3, 0)]),
}


def shaped(points, **more):
    return DockGeometry(tuple(f"m{i}" for i in range(len(points))), points, "dock.toml", **more)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(
    ("axes", "says"),
    [(ROS, "ROS's (x forward, y left, z up) write [-y, -z, x]"), (Z_UP, "z up write [x, -z, y]")],
)
def test_a_dock_in_other_axes_is_refused_with_the_way_to_write_it(shape, axes, says):
    points = SHAPES[shape]
    for origin in ((0, 0, 0), (3, -20, 1)):
        measured = (points + origin) @ axes.T
        with pytest.raises(ChromadockError) as raised:
            shaped(measured)
        line = str(raised.value)
        assert "edge-on (x is right, y down, z away from them)" in line
        assert says in line
        assert "\n" not in line and len(line) < 240
        assert shaped(measured, confirmed=True).names
    x, y, z = measured.T
    written = np.column_stack([-y, -z, x] if axes is ROS else [x, -z, y])
    assert np.allclose(shaped(written).points, points + origin)


@pytest.mark.parametrize(
    "points",
    [
        *SHAPES.values(),
        # A row of lamps bent back at its ends, a box, one lamp straight before another, and a
        # plane that is turned far away.
        [(-0.5, 0, 0.1), (-0.17, 0, 0), (0.17, 0, 0), (0.5, 0, 0.1)],
        [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0, 0.5)],
        [(-0.5, -0.3, 0), (0.5, -0.3, 0), (0, 0.3, 0), (0, 0.3, -0.4)],
        [(0, -0.3, 0), (0.2, -0.3, 0.5), (0, 0.3, 0), (0.2, 0.3, 0.5)],
    ],
)
def test_a_dock_whose_markers_are_seen_apart_is_taken(points):
    assert shaped(np.array(points)).confirmed is False


def test_a_dock_of_more_than_10_metres_wants_to_be_confirmed(load):
    text = dock_text([("a", "[0, 0, 0]"), ("b", "[12, 0, 0]"), ("c", "[0, 5, 0]")])
    with pytest.raises(ChromadockError, match=r"13 m apart: .* confirm with --yes, or confirmed ="):
        load(text)
    assert load("confirmed = true\n" + text).points[1, 0] == 12
    # However far from its origin: size is between markers.
    assert load(text.replace("12", "8").replace("[0,", "[300,").replace("[8,", "[308,")).names


def test_a_byte_order_mark_is_no_part_of_the_file(tmp_path):
    text = dock_text(THREE.items()).replace("\n", "\r\n")
    for encoding in ("utf-8-sig", "utf-16"):
        (tmp_path / "dock.toml").write_bytes(text.encode(encoding))
        assert DockGeometry.from_toml(tmp_path / "dock.toml").names == ("a", "b", "c")


@pytest.mark.skipif(not REPORTS.is_dir(), reason="no reports: ../shared/data is missing")
@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("bom.toml", None),
        ("far_origin.toml", None),
        ("centimetres.toml", "if these are centimetres, divide all by 100 (0.899 m)"),
        ("ros_axes.toml", "ROS's (x forward, y left, z up) write [-y, -z, x]"),
        ("z_up_plane.toml", "x right, y forward, z up write [x, -z, y]"),
    ],
)
def test_files_of_reports_are_read_or_refused(name, says):
    if says is None:
        assert len(DockGeometry.from_toml(REPORTS / name).names) == 4
        return
    with pytest.raises(ChromadockError) as raised:
        DockGeometry.from_toml(REPORTS / name)
    assert says in str(raised.value)
    assert DockGeometry.from_toml(REPORTS / name, confirmed=True).confirmed


def test_a_missing_dock_file_is_refused(tmp_path):
    with pytest.raises(ChromadockError, match=r"none\.toml: cannot be read .*No such file"):
        DockGeometry.from_toml(tmp_path / "none.toml")


def test_a_dock_made_in_python_is_checked_too():
    with pytest.raises(ChromadockError, match="3 names but points of shape"):
        DockGeometry(("a", "b", "c"), np.zeros((4, 3)))


def test_a_dock_cannot_be_changed_behind_its_back():
    dock = DockGeometry.default()
    with pytest.raises(ValueError, match="read-only"):
        dock.points[0, 0] = 1
    assert np.array_equal(dock.points, DockGeometry.default().points)


def test_a_pose_is_judged_by_the_origin_or_the_point_of_the_dock_towards_it():
    square = np.array([[1.0, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])
    names = ("a", "b", "c", "d")
    near, far = np.array([0.5, 0.0, -1.0]), np.array([0.0, 0.0, -20.0])
    assert DockGeometry(names, square).judged == pytest.approx(np.zeros(3))
    assert DockGeometry(names, square - near).judged == pytest.approx(np.zeros(3))
    assert DockGeometry(names, square - far).judged == pytest.approx([0, 0, 20 - np.sqrt(2)])
