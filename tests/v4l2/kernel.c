/* Cameras that are not there, for programs that are started with
 * LD_PRELOAD=kernel.so.
 *
 * A device is a file videoN in the folder CHROMADOCK_TEST_CAMERAS, or a
 * symbolic link there to one; its state is in videoN.state.  Structures and
 * requests are those of the kernel's own header.
 */
#define _GNU_SOURCE
#include "camera.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#define FILES 1024

static struct opened files[FILES];

int fail(int error)
{
    errno = error;
    return -1;
}

/* The state's file of a device; false where the path is none of ours. */
static bool state_of(const char *path, char *state, size_t size)
{
    const char *folder = getenv("CHROMADOCK_TEST_CAMERAS");
    if (folder == NULL || strncmp(path, folder, strlen(folder)) != 0) {
        return false;
    }
    char target[PATH_MAX];
    const ssize_t length = readlink(path, target, sizeof target - 1);
    if (length > 0) {
        target[length] = 0;
        if (strncmp(target, folder, strlen(folder)) == 0) {
            path = target;
        }
    }
    return snprintf(state, size, "%s.state", path) < (int)size &&
           access(state, F_OK) == 0;
}

static int open_camera(const char *state)
{
    const int kept =
        (int)syscall(SYS_openat, AT_FDCWD, state, O_RDWR | O_CLOEXEC, 0);
    if (kept < 0) {
        return -1;
    }
    struct camera *camera =
        mmap(NULL, sizeof *camera, PROT_READ | PROT_WRITE, MAP_SHARED, kept, 0);
    close(kept);
    if (camera == MAP_FAILED) {
        return -1;
    }
    const int file = memfd_create("camera", MFD_CLOEXEC);
    if (file < 0 || file >= FILES ||
        ftruncate(file, BUFFERS * PICTURE_BYTES) < 0) {
        return fail(EMFILE);
    }
    unsigned char *pictures = mmap(NULL, BUFFERS * PICTURE_BYTES,
                                   PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (pictures == MAP_FAILED) {
        return -1;
    }
    files[file] = (struct opened){.camera = camera, .pictures = pictures};
    return file;
}

typedef int (*open_function)(const char *, int, ...);
typedef int (*ioctl_function)(int, unsigned long, ...);
typedef int (*close_function)(int);

static int open_as(const char *name, const char *path, int flags, mode_t mode)
{
    char state[PATH_MAX];
    if (state_of(path, state, sizeof state)) {
        return open_camera(state);
    }
    const open_function real = (open_function)dlsym(RTLD_NEXT, name);
    return real(path, flags, mode);
}

static mode_t mode_of(int flags, va_list rest)
{
    return (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE
               ? va_arg(rest, mode_t)
               : 0;
}

int open(const char *path, int flags, ...)
{
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = mode_of(flags, rest);
    va_end(rest);
    return open_as("open", path, flags, mode);
}

int open64(const char *path, int flags, ...)
{
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = mode_of(flags, rest);
    va_end(rest);
    return open_as("open64", path, flags, mode);
}

int close(int file)
{
    if (file >= 0 && file < FILES) {
        files[file].camera = NULL;
    }
    const close_function real = (close_function)dlsym(RTLD_NEXT, "close");
    return real(file);
}

int ioctl(int file, unsigned long request, ...)
{
    va_list rest;
    va_start(rest, request);
    void *argument = va_arg(rest, void *);
    va_end(rest);
    struct opened *ours = file >= 0 && file < FILES ? &files[file] : NULL;
    if (ours == NULL || ours->camera == NULL) {
        const ioctl_function real = (ioctl_function)dlsym(RTLD_NEXT, "ioctl");
        return real(file, request, argument);
    }
    if (ours->camera->gone) {
        return fail(ENODEV);
    }
    const unsigned long code = request & 0xffffffffUL;
    const int answered = answer_control(ours->camera, code, argument);
    return answered < 0 && errno == ENOTTY ? answer_stream(ours, code, argument)
                                           : answered;
}
