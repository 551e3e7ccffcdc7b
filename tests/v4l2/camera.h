/* A camera's state, in a file that the fake kernel and the test both map: every
 * field has 32 bits, in this order, as tests/v4l2_camera.py packs it. */
#ifndef CHROMADOCK_TEST_V4L2_CAMERA_H
#define CHROMADOCK_TEST_V4L2_CAMERA_H

#include <linux/videodev2.h>
#include <stdbool.h>
#include <stdint.h>

#define CAMERA_CONTROLS 16

/* What is wrong with a control. */
enum fault {
    FAULT_NONE,
    FAULT_IGNORES,    /* takes a value and keeps the old one */
    FAULT_BUSY,       /* EBUSY for every value */
    FAULT_COARSE,     /* keeps multiples of 50 alone */
    FAULT_UNREADABLE, /* EIO when it is asked for */
    FAULT_FORGETS,    /* goes back to its default when the stream begins */
};

struct control {
    uint32_t id; /* 0: none */
    uint32_t type;
    int32_t minimum, maximum, step, initial;
    int32_t value;
    uint32_t menu;      /* bits of the entries that a menu has */
    uint32_t automatic; /* id of the control that makes this one automatic; 0:
                           none */
    uint32_t fault;
};

struct camera {
    uint32_t gone;     /* unplugged: ENODEV for everything */
    uint32_t pictures; /* delivered so far */
    struct control controls[CAMERA_CONTROLS];
};

#define PICTURE_BYTES 8192 /* of a buffer */
#define BUFFERS 4

/* A device as one program has it open. */
struct opened {
    struct camera *camera; /* NULL: no device of ours */
    unsigned char *pictures;
    uint32_t queue[BUFFERS], queued, sequence;
    bool streams;
};

/* The control of a number; NULL where the camera has none. */
struct control *find_control(struct camera *camera, uint32_t id);

/* Answer one request of either kind as ioctl does; ENOTTY where it is of the
 * other. */
int answer_control(struct camera *camera, unsigned long request,
                   void *argument);
int answer_stream(struct opened *file, unsigned long request, void *argument);

/* Give -1 and set errno. */
int fail(int error);

#endif
