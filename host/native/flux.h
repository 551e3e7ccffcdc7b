/* The light of lamps: chromadock.robust's frame/flux.py says what for.
 *
 * Nothing here allocates memory or keeps anything between two calls; all
 * arrays belong to the caller. Calls from several threads are independent. */
#ifndef FLUX_H
#define FLUX_H

#include <stdint.h>

/* Outer radius of the ring that tells the light behind a lamp, in radii of the
 * disc whose light is added up. */
#define FLUX_RING 1.5

/* Pixels along a disc's radius that are looked at, at most: of larger discs
 * every so many-th. */
#define FLUX_STEPS 12

/* Adds up the light of discs, less the median of the ring around each.
 *
 * bgr: height x width x 3 codes. linear: the light of each of 256 codes.
 * places: count x 2, x and y in pixels. radius: of the discs, pixels.
 * added: receives count x 3, BGR: light times pixels; what is beyond the
 * picture's border adds nothing. variance: receives as many: of these, if
 * pixels scatter in the disc as they do in its ring, each by itself. */
void flux_measure(const uint8_t *bgr, int32_t height, int32_t width,
                  const float *linear, int32_t count, const double *places,
                  double radius, double *added, double *variance);

#endif
