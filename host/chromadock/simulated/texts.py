"""What a board prints that is no message, as an ESP32-CAM prints it."""

from __future__ import annotations

POWER_ON = "rst:0x1 (POWERON_RESET)"
SOFTWARE = "rst:0xc (SW_CPU_RESET)"

RESET_REASONS = {POWER_ON: 1, SOFTWARE: 3}
"""As ``esp_reset_reason`` counts."""

DRIVER = b"cam_hal: EV-EOF-OVF\r\n"


def boot_text(reset: str) -> bytes:
    """The ROM's log."""
    lines = (
        "ets Jul 29 2019 12:21:46",
        "",
        f"{reset},boot:0x13 (SPI_FAST_FLASH_BOOT)",
        "configsip: 0, SPIWP:0xee",
        "clk_drv:0x00,q_drv:0x00,d_drv:0x00,cs0_drv:0x00,hd_drv:0x00,wp_drv:0x00",
        "mode:DIO, clock div:2",
        "load:0x3fff0030,len:1184",
        "load:0x40078000,len:13232",
        "load:0x40080400,len:3028",
        "entry 0x400805e4",
        "",
    )
    return "\r\n".join(lines).encode("ascii")
