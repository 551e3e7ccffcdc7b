/* Everything of dockcore, for the Python binding and the tests. */
#ifndef DOCKCORE_H
#define DOCKCORE_H

#include "background.h"
#include "dock.h"
#include "frame.h"
#include "hsv.h"
#include "hue.h"
#include "led.h"
#include "marker.h"
#include "method.h"
#include "parameter_table.h"
#include "pixel.h"
#include "real32.h"
#include "rolling.h"
#include "settings_blob.h"
#include "smooth.h"
#include "steady.h"
#include "working_image.h"

#endif
