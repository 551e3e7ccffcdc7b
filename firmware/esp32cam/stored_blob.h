/* A blob of settings as one of its two places holds it. */
#ifndef STORED_BLOB_H
#define STORED_BLOB_H

#include "core.h"

struct stored_blob_t {
    uint8_t bytes[SETTINGS_BLOB_LONGEST];
    size_t length; /* 0: none that can be read */
    bool missing;  /* nothing was ever written there */
};

#endif
