"""The simulated dock by itself."""

import cv2
import numpy as np
import pytest
from simulated_bench import REBOOT, SAVE, Bench, led_limit, limit, parameter

from chromadock import dialect
from chromadock.link.commands import command_long
from chromadock.link.framing import FrameFinder
from chromadock.link.rgb565 import HEIGHT, WIDTH


def test_it_starts_with_the_boot_loaders_text_then_heartbeats():
    bench = Bench().run(3)
    assert b"rst:0x1 (POWERON_RESET),boot:0x13 (SPI_FAST_FLASH_BOOT)" in bench.bytes
    assert bench.bytes.index(b"rst:0x1") < bench.bytes.index(b"\xfd")
    assert 2 <= len(bench.all("HEARTBEAT")) <= 4
    assert "started" in bench.said()[0]


def test_the_camera_is_locked_after_settling():
    bench = Bench().run(0.4)
    assert bench.status().faults & dialect.DOCK_FAULT_UNLOCKED
    bench.run(1)
    assert bench.status().faults == 0
    assert (bench.status().exposure, bench.status().gain) == (300, 4)


def test_its_leds_are_dark_until_the_first_frame_then_show_the_marker():
    bench = Bench()
    assert bench.dock.duties == (0, 0, 0)
    bench.run(0.5)
    assert bench.dock.duties == (4096, 0, 2070)
    assert list(bench.status().duty) == [4096, 0, 2070]


@pytest.mark.parametrize("fps", [0.1, 1, 30])
def test_it_decides_at_the_chosen_frame_rate(fps):
    bench = Bench(fps=fps).run(20 + 0.5)
    assert bench.status().frames == pytest.approx(fps * 20, abs=max(1, 0.03 * fps * 20))


def test_a_setting_is_kept_over_a_reboot_only_if_saved():
    bench = Bench().run(0.5).send(limit(100), SAVE)
    assert bench.result() == dialect.MAV_RESULT_ACCEPTED
    bench.send(limit(50)).send(REBOOT).run(1)
    assert b"rst:0xc (SW_CPU_RESET)" in bench.bytes
    assert bench.status().time_boot_ms < 2000
    assert bench.status().reset_reason == 3
    assert led_limit(bench) == 100


def test_a_setting_is_kept_in_its_file_for_the_next_simulation(tmp_path):
    file = tmp_path / "flash"
    Bench(settings=file).run(0.5).send(limit(100), SAVE)
    assert [p.name for p in tmp_path.iterdir()] == ["flash"]
    assert led_limit(Bench(settings=file).run(0.5)) == 100


@pytest.mark.parametrize("cut", [0, 1, 100])
def test_corrupt_settings_give_way_to_the_defaults_and_it_says_so(tmp_path, cut):
    file = tmp_path / "flash"
    Bench(settings=file).run(0.5).send(limit(100), SAVE)
    blob = bytearray(file.read_bytes())
    blob[40] ^= 1
    file.write_bytes(blob[: len(blob) - cut])
    bench = Bench(settings=file).run(1)
    assert bench.status().faults & dialect.DOCK_FAULT_SETTINGS
    assert "stored settings corrupt: defaults in use" in bench.said()
    assert led_limit(bench) == 255
    bench.send(SAVE).run(0.5)  # mends it
    assert bench.status().faults == 0


def test_settings_that_cannot_be_saved_are_reported(tmp_path):
    bench = Bench(settings=tmp_path / "missing" / "flash").run(1).send(SAVE).run(0.5)
    assert bench.result() == dialect.MAV_RESULT_FAILED
    assert bench.status().faults & dialect.DOCK_FAULT_STORAGE


def test_saving_takes_as_long_as_on_a_board_and_the_camera_waits():
    bench = Bench(fps=10, save_s=2).run(1).send(SAVE)
    frames = bench.status().frames
    assert bench.result() == dialect.MAV_RESULT_IN_PROGRESS
    bench.run(1.5)
    assert bench.status().frames <= frames + 1
    assert bench.result() == dialect.MAV_RESULT_IN_PROGRESS
    bench.run(1.5)
    assert bench.status().frames > frames + 5
    assert bench.result() == dialect.MAV_RESULT_ACCEPTED


def test_power_that_is_lost_while_saving_leaves_the_old_settings(tmp_path):
    file = tmp_path / "flash"
    bench = Bench("reboot@2s", settings=file, save_s=1).run(1.5).send(limit(100), SAVE).run(3)
    assert led_limit(bench) == 255
    assert not file.exists()


def test_the_storage_fault_begins_at_its_time():
    bench = Bench("storage@2s").run(1).send(SAVE)
    assert bench.result() == dialect.MAV_RESULT_ACCEPTED
    bench.run(1).send(SAVE)
    assert bench.result() == dialect.MAV_RESULT_FAILED


def test_after_a_camera_timeout_the_camera_is_back():
    bench = Bench("camera-timeout@2s").run(3)
    frames = bench.status().frames
    bench.run(2)
    assert bench.status().frames - frames <= 1
    bench.run(1.6)
    assert bench.status().camera_faults == 1
    assert [text for text in bench.said() if "camera" in text] == [
        "camera gives no frame: colour kept, restarting it",
        "camera is back",
    ]
    assert bench.status().faults == 0
    assert bench.status().frames > frames


def test_a_lost_camera_leaves_the_colour_and_the_link_as_they_were():
    bench = Bench("camera-lost@2s").run(2)
    duties, frames = bench.dock.duties, bench.status().frames
    bench.run(10)
    assert bench.status().faults & dialect.DOCK_FAULT_CAMERA
    assert bench.status().camera_faults == 3  # a grab gives up after four seconds
    assert bench.dock.duties == duties
    assert bench.status().frames <= frames + 1
    assert led_limit(bench) == 255


def dark_picture(folder):
    file = folder / "night.png"
    cv2.imwrite(str(file), np.zeros((HEIGHT, WIDTH, 3), np.uint8))
    return str(file)


@pytest.mark.parametrize("own_light", [0.003, 0.01, 0.05])
def test_at_night_it_does_not_follow_its_own_light_and_says_so(tmp_path, own_light):
    bench = Bench(source=dark_picture(tmp_path), own_light=own_light).run(30)
    since = len(bench.all("DOCK_STATUS"))
    bench.run(60)
    assert {s.marker_hue for s in bench.all("DOCK_STATUS")[since:]} == {512}
    assert bench.status().faults == dialect.DOCK_FAULT_OWN_LIGHT


def test_its_leds_go_out_for_a_frame_now_and_then_and_never_for_long(tmp_path):
    bench = Bench(source=dark_picture(tmp_path), own_light=0.05).run(1)
    dark, longest_s, out_s = None, 0.0, 0.0
    for _ in range(12_000):
        bench.run(0.005, step_s=0.005)
        if bench.dock.lamps == (0, 0, 0):
            dark = bench.now_s if dark is None else dark
        elif dark is not None:
            longest_s = max(longest_s, bench.now_s - dark)
            out_s, dark = out_s + bench.now_s - dark, None
    assert 0.05 < longest_s < 0.2
    assert 0 < out_s <= 0.02 * 60


@pytest.mark.parametrize("own_light", [0.0, 0.05])
@pytest.mark.parametrize("faults", [(), ("camera-lost@2s",)])
def test_it_remembers_no_more_of_its_lamps_than_a_frame_takes(own_light, faults):
    """Lamps that are set anew all the time."""
    bench, shown = Bench(*faults, own_light=own_light).run(3), set()
    for k in range(60):
        raw = command_long(dialect.MAV_CMD_DOCK_LED, dialect.DOCK_LED_RAW, 4 * k, 0, 255 - k)
        bench.send(raw).run(0.5)
        assert bench.result() == dialect.MAV_RESULT_ACCEPTED
        shown.add(bench.dock.duties)
        assert len(bench.dock._own_light._driven) < 10
    assert len(shown) > 10


def test_without_own_light_all_frames_decide(tmp_path):
    bench = Bench(own_light=0.0).run(90)
    assert bench.status().faults == 0


def test_a_camera_lost_from_the_start_leaves_the_fallback_after_15_seconds():
    bench = Bench("camera-lost@0s").run(14)
    assert bench.dock.lamps == (0, 0, 0)
    bench.run(3)
    assert bench.dock.lamps == (0, 1, 0)
    assert bench.status().frame_rate_dhz == bench.status().confidence == 0


def test_the_hue_comes_back_after_a_reboot_but_not_after_a_loss_of_power():
    for restart, lamps in ((REBOOT, "before"), (None, (0, 1, 0))):
        faults = ["camera-lost@2s"] + ([] if restart else ["reboot@3s"])
        bench = Bench(*faults).run(1.5)
        before = bench.dock.lamps
        bench.run(1)
        if restart:
            bench.send(restart)
        bench.run(25)
        assert bench.dock.lamps == (before if lamps == "before" else lamps)


def test_the_reboot_fault_starts_it_anew():
    bench = Bench("reboot@3s").run(4)
    assert bench.bytes.count(b"rst:0x1 (POWERON_RESET)") == 2
    assert bench.status().time_boot_ms < 1100


def test_text_and_noise_come_between_messages_at_their_time():
    bench = Bench("boot-text@1s", "noise@2s").run(4)
    assert bench.bytes.count(b"rst:0x1 (POWERON_RESET)") == 2
    assert bench.status().time_boot_ms > 3500  # no restart
    quiet = Bench("boot-text@1s").run(4)
    assert len(bench.bytes) - len(quiet.bytes) == 256
    assert len(bench.all("DOCK_STATUS")) >= len(quiet.all("DOCK_STATUS")) - 2


def test_driver_text_costs_at_most_the_messages_that_it_hits():
    bench = Bench("driver-text@1s").run(6)
    texts = bench.bytes.count(b"cam_hal: EV-EOF-OVF\r\n")
    assert texts == pytest.approx(10, abs=1)
    plain = Bench().run(6)
    lost = len(plain.messages) - len(bench.messages)
    assert 0 < lost <= texts


def test_corruption_is_the_same_for_the_same_seed_and_costs_some_messages():
    first, again, other = (Bench("corrupt=0.01", seed=seed).run(5).bytes for seed in (1, 1, 2))
    assert first == again != other
    assert 0 < FrameFinder().feed(first).__len__() < len(Bench().run(5).messages)


def test_it_goes_on_when_its_clock_wraps():
    bench = Bench().run(1)
    bench.now_s = 2**32 / 1000 - 1  # 49.7 days later
    bench.run(0.9)
    frames, beats = bench.status().frames, len(bench.all("HEARTBEAT"))
    bench.run(3)
    assert bench.status().time_boot_ms < 5000
    assert bench.status().frames >= frames + 29
    assert len(bench.all("HEARTBEAT")) >= beats + 2


def test_the_dock_sees_the_colour_that_its_source_has(tmp_path):
    picture = tmp_path / "green.png"
    cv2.imwrite(str(picture), np.full((480, 640, 3), (0, 200, 40), np.uint8))
    status = Bench(source=str(picture)).run(0.5).status()
    red, green, blue = status.background_rgb
    assert green > 150 > red > blue


def test_a_camera_at_rest_gives_a_frame_each_interval_and_wakes_when_it_is_changed():
    bench = Bench().run(2)
    frames = bench.status().frames
    bench.send(parameter("DECISION_MS", 5000)).run(20)
    assert 2 <= bench.status().frames - frames <= 8
    frames = bench.status().frames
    bench.send(parameter("DECISION_MS", 0)).run(2)
    assert bench.status().frames - frames == pytest.approx(21, abs=3)
