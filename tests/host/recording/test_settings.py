"""The settings in a recording, and the layout that shows it in Foxglove."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from filmed_approach import CAMERA, CAMERA_YAML
from recorded_dive import read

from chromadock.output.run_setup import RunSetup
from chromadock.vehicle.keys import CameraKeys, DockKeys, MountingKeys, VehicleFile
from chromadock.vehicle.manual import as_toml
from chromadock.vehicle.reading import read_vehicle


def test_the_settings_come_back_with_the_files_that_they_name(tmp_path: Path) -> None:
    (tmp_path / "cam.yaml").write_text(CAMERA_YAML)
    settings = VehicleFile(
        camera=CameraKeys(
            source="rtsp://pilot:secret@192.168.2.2/cam?token=1",
            calibration=str(tmp_path / "cam.yaml"),
        ),
        mounting=MountingKeys(pitch_deg=-20.0),
        dock=DockKeys(colour="#0000FF", mapping="contrast"),
    )
    files = RunSetup(settings, CAMERA).files()
    assert files["camera.yaml"].decode() == CAMERA_YAML
    assert not any(b"secret" in content or b"token" in content for content in files.values())
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
    again = read_vehicle(tmp_path / "vehicle.toml")
    assert again.mounting == settings.mounting and again.detector == settings.detector
    assert again.dock == settings.dock.model_copy(update={"file": str(tmp_path / "dock.toml")})
    assert again.camera.source == "rtsp://...@192.168.2.2/cam..."


def test_settings_written_are_read_as_the_same(tmp_path: Path) -> None:
    odd = VehicleFile(camera=CameraKeys(source='a "quoted" \\ väg\n'), mounting=MountingKeys())
    for settings in (VehicleFile(), odd):
        (tmp_path / "v.toml").write_text(as_toml(settings), encoding="utf-8")
        assert read_vehicle(tmp_path / "v.toml") == settings


LAYOUT = Path(__file__).resolve().parents[3] / "docs" / "foxglove_layout.json"


def test_the_layout_for_foxglove_shows_what_is_recorded(recorded: Path) -> None:
    """Each panel is placed once, and what it shows has messages with such a field."""
    layout = json.loads(LAYOUT.read_text())
    placed = leaves(layout["layout"])
    assert sorted(placed) == sorted(layout["configById"])
    assert {name.partition("!")[0] for name in placed} >= {
        "Image", "3D", "DiagnosticStatusPanel", "Plot"
    }  # fmt: skip
    found = read(recorded)
    named = set(re.findall(r'"(/[a-z_/]+)[".]', LAYOUT.read_text()))
    assert named <= set(found) and len(named) == 5
    plots = layout["configById"]["Plot!chromadock"]["paths"]
    for topic, *fields in (path["value"].split(".") for path in plots):
        value = found[topic][0][1]
        for field in fields:
            value = getattr(value, field)
        assert isinstance(value, float)
    status = found["/diagnostics"][0][1].status[0]
    panel = layout["configById"]["DiagnosticStatusPanel!chromadock"]
    assert (status.hardware_id, status.name) == (panel["selectedHardwareId"], panel["selectedName"])
    assert '"frame:camera_optical_frame"' in LAYOUT.read_text()


def leaves(node: Any) -> list[str]:
    """Panels of a layout's tree."""
    if isinstance(node, str):
        return [node]
    return [*leaves(node["first"]), *leaves(node["second"])]
