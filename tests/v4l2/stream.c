/* Pictures of a camera: YUYV, 30 a second, as bright as the exposure is long in
 * 0.1 ms. */
#define _GNU_SOURCE
#include "camera.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { WIDTH = 64, HEIGHT = 48, PICTURE = WIDTH * HEIGHT * 2, BRIGHTEST = 235 };

static int format(struct v4l2_format *f)
{
    if (f->type != V4L2_BUF_TYPE_VIDEO_CAPTURE) {
        return fail(EINVAL);
    }
    memset(&f->fmt, 0, sizeof f->fmt);
    f->fmt.pix.width = WIDTH;
    f->fmt.pix.height = HEIGHT;
    f->fmt.pix.pixelformat = V4L2_PIX_FMT_YUYV;
    f->fmt.pix.field = V4L2_FIELD_NONE;
    f->fmt.pix.bytesperline = WIDTH * 2;
    f->fmt.pix.sizeimage = PICTURE;
    return 0;
}

static int capabilities(struct v4l2_capability *c)
{
    memset(c, 0, sizeof *c);
    snprintf((char *)c->driver, sizeof c->driver, "uvcvideo");
    snprintf((char *)c->card, sizeof c->card, "camera of a test");
    c->device_caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
    c->capabilities = c->device_caps | V4L2_CAP_DEVICE_CAPS;
    return 0;
}

static int rate(struct v4l2_streamparm *p)
{
    p->parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
    p->parm.capture.timeperframe = (struct v4l2_fract){1, 30};
    return 0;
}

static int buffer(struct v4l2_buffer *b)
{
    if (b->index >= BUFFERS) {
        return fail(EINVAL);
    }
    b->length = PICTURE_BYTES;
    b->m.offset = b->index * PICTURE_BYTES;
    return 0;
}

static int begin(struct opened *file)
{
    for (int i = 0; i < CAMERA_CONTROLS; i++) {
        struct control *c = &file->camera->controls[i];
        if (c->fault == FAULT_FORGETS) {
            c->value = c->initial;
        }
    }
    file->streams = true;
    return 0;
}

static int dequeue(struct opened *file, struct v4l2_buffer *b)
{
    const struct timespec period = {0, 33 * 1000 * 1000};
    nanosleep(&period, NULL);
    if (file->camera->gone) {
        return fail(ENODEV);
    }
    if (!file->streams || file->queued == 0) {
        return fail(EAGAIN);
    }
    b->index = file->queue[0];
    file->queued--;
    memmove(file->queue, file->queue + 1, file->queued * sizeof file->queue[0]);
    const struct control *exposure =
        find_control(file->camera, V4L2_CID_EXPOSURE_ABSOLUTE);
    const int bright = exposure == NULL ? 128 : exposure->value;
    unsigned char *picture = file->pictures + b->index * PICTURE_BYTES;
    for (int i = 0; i < PICTURE; i += 2) {
        picture[i] = (unsigned char)(bright > BRIGHTEST ? BRIGHTEST : bright);
        picture[i + 1] = 128;
    }
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    b->timestamp.tv_sec = now.tv_sec;
    b->timestamp.tv_usec = now.tv_nsec / 1000;
    b->flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    b->bytesused = PICTURE;
    b->sequence = file->sequence++;
    file->camera->pictures++;
    return buffer(b);
}

static int enqueue(struct opened *file, const struct v4l2_buffer *b)
{
    if (b->index >= BUFFERS || file->queued == BUFFERS) {
        return fail(EINVAL);
    }
    file->queue[file->queued++] = b->index;
    return 0;
}

static int buffers(struct v4l2_requestbuffers *b)
{
    b->count = b->count > 0 ? BUFFERS : 0;
    return 0;
}

static int end(struct opened *file)
{
    file->streams = false;
    file->queued = 0;
    return 0;
}

static int input(int *index)
{
    *index = 0;
    return 0;
}

int answer_stream(struct opened *file, unsigned long request, void *argument)
{
    switch (request) {
    case VIDIOC_QUERYCAP:
        return capabilities(argument);
    case VIDIOC_G_FMT:
    case VIDIOC_S_FMT:
    case VIDIOC_TRY_FMT:
        return format(argument);
    case VIDIOC_G_PARM:
    case VIDIOC_S_PARM:
        return rate(argument);
    case VIDIOC_G_INPUT:
    case VIDIOC_S_INPUT:
        return input(argument);
    case VIDIOC_REQBUFS:
        return buffers(argument);
    case VIDIOC_QUERYBUF:
        return buffer(argument);
    case VIDIOC_QBUF:
        return enqueue(file, argument);
    case VIDIOC_DQBUF:
        return dequeue(file, argument);
    case VIDIOC_STREAMON:
        return begin(file);
    case VIDIOC_STREAMOFF:
        return end(file);
    default:
        return fail(ENOTTY);
    }
}
