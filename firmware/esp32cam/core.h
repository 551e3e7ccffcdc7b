/* dockcore, which is C and says nothing of C++. */
#ifndef CORE_H
#define CORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

extern "C" {
#include <dock.h>
#include <settings_blob.h>
}

#endif
