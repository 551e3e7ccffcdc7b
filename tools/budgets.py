"""What dock and vehicle may cost; the tests hold the dock's, `make bench` shows them all."""

# Of one QQVGA RGB565 frame to PWM duties: 2.5 ms of the ESP32 at one instruction a cycle.
INSTRUCTIONS_QQVGA = 600_000

CODE_BYTES = 32 * 1024  # with tables
RAM_BYTES = 24 * 1024
STACK_BYTES = 1536

# Detector.process against one 5 x 5 Gaussian blur of the same VGA frame, one thread.
BLUR_RATIO = 5

RESIDENT_MIB = 200  # of `chromadock detect` on VGA video
