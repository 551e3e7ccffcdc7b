/* Controls as uvcvideo has them: values are clamped to the range and rounded to
 * the step, a menu without the entry is EINVAL, beyond it ERANGE, and what is
 * automatic is inactive and EACCES. */
#include "camera.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

static bool is_automatic(const struct camera *camera, uint32_t id)
{
    for (int i = 0; i < CAMERA_CONTROLS; i++) {
        const struct control *c = &camera->controls[i];
        if (c->id == id && id != 0) {
            return id == V4L2_CID_EXPOSURE_AUTO
                       ? c->value == V4L2_EXPOSURE_AUTO ||
                             c->value == V4L2_EXPOSURE_APERTURE_PRIORITY
                       : c->value == 1;
        }
    }
    return false;
}

struct control *find_control(struct camera *camera, uint32_t id)
{
    for (int i = 0; i < CAMERA_CONTROLS; i++) {
        if (camera->controls[i].id == id && id != 0) {
            return &camera->controls[i];
        }
    }
    return NULL;
}

static bool is_menu(const struct control *control)
{
    return control->type == V4L2_CTRL_TYPE_MENU;
}

static int query(struct camera *camera, struct v4l2_queryctrl *q)
{
    const struct control *c = find_control(camera, q->id);
    if (c == NULL) {
        return fail(EINVAL);
    }
    q->type = c->type;
    snprintf((char *)q->name, sizeof q->name, "control %x", c->id);
    q->minimum = c->minimum;
    q->maximum = c->maximum;
    q->step = c->step;
    q->default_value = c->initial;
    q->flags = is_automatic(camera, c->automatic) ? V4L2_CTRL_FLAG_INACTIVE : 0;
    memset(q->reserved, 0, sizeof q->reserved);
    return 0;
}

static int query_menu(struct camera *camera, struct v4l2_querymenu *q)
{
    const struct control *c = find_control(camera, q->id);
    if (c == NULL || !is_menu(c) || q->index > 31 ||
        !(c->menu >> q->index & 1)) {
        return fail(EINVAL);
    }
    snprintf((char *)q->name, sizeof q->name, "entry %u", q->index);
    return 0;
}

static int get(struct camera *camera, struct v4l2_control *v)
{
    const struct control *c = find_control(camera, v->id);
    if (c == NULL || c->fault == FAULT_UNREADABLE) {
        return fail(c == NULL ? EINVAL : EIO);
    }
    v->value = c->value;
    return 0;
}

static int set(struct camera *camera, struct v4l2_control *v)
{
    struct control *c = find_control(camera, v->id);
    if (c == NULL) {
        return fail(EINVAL);
    }
    if (c->fault == FAULT_BUSY) {
        return fail(EBUSY);
    }
    if (is_automatic(camera, c->automatic)) {
        return fail(EACCES);
    }
    if (is_menu(c)) {
        if (v->value < c->minimum || v->value > c->maximum) {
            return fail(ERANGE);
        }
        if (!(c->menu >> v->value & 1)) {
            return fail(EINVAL);
        }
    } else {
        int32_t value = v->value < c->minimum ? c->minimum : v->value;
        value = value > c->maximum ? c->maximum : value;
        v->value =
            c->minimum + (value - c->minimum + c->step / 2) / c->step * c->step;
    }
    if (c->fault == FAULT_COARSE) {
        c->value = v->value / 50 * 50;
    } else if (c->fault != FAULT_IGNORES) {
        c->value = v->value;
    }
    return 0;
}

int answer_control(struct camera *camera, unsigned long request, void *argument)
{
    switch (request) {
    case VIDIOC_QUERYCTRL:
        return query(camera, argument);
    case VIDIOC_QUERYMENU:
        return query_menu(camera, argument);
    case VIDIOC_G_CTRL:
        return get(camera, argument);
    case VIDIOC_S_CTRL:
        return set(camera, argument);
    default:
        return fail(ENOTTY);
    }
}
