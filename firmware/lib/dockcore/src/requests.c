#include "requests.h"

void requests_save(requests_t *requests)
{
    if (requests->save == SAVE_NONE)
        requests->save = SAVE_WANTED;
}

void requests_camera(requests_t *requests)
{
    requests->camera = true;
}

void requests_reboot(requests_t *requests)
{
    requests->reboot = true;
}

dock_request_t requests_take(requests_t *requests, bool answered)
{
    if (requests->save == SAVE_WANTED) {
        requests->save = SAVE_WRITING;
        return DOCK_REQUEST_SAVE;
    }
    if (requests->camera) {
        requests->camera = false;
        return DOCK_REQUEST_CAMERA;
    }
    if (requests->reboot && answered && requests->save == SAVE_NONE) {
        requests->reboot = false;
        return DOCK_REQUEST_REBOOT;
    }
    return DOCK_REQUEST_NONE;
}

bool requests_saved(requests_t *requests, bool written)
{
    const bool asked = requests->save != SAVE_NONE;
    requests->save = SAVE_NONE;
    requests->failed = !written;
    return asked;
}
