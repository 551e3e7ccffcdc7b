/* Whether two places of a frame are on one bright thing: chromadock.robust's
 * frame/plateau.py says what for.
 *
 * Nothing here allocates memory or keeps anything between two calls; all
 * arrays belong to the caller. Calls from several threads are independent. */
#ifndef PLATEAU_H
#define PLATEAU_H

#include <stdint.h>

/* Places between two markers that are looked at, and as many beyond each. */
enum { PLATEAU_SAMPLES = 15 };

/* Codes of 255 by which some channel of both ends is brighter than what is
 * beyond them: of fainter lamps noise hides whether it is dark between them. */
#define PLATEAU_LEAST_EXCESS 10.0

/* It is darker between two lamps by so many codes, or by so much of that
 * excess: more than noise and JPEG do to one thing. It may be so along the
 * excess as a vector of (B, G, R), or in one of the channels that stand out by
 * the least excess: before a white bar in the lamps' own. What lamps add
 * nothing to has only its noise to tell, and is not asked. */
#define PLATEAU_DIP 6.0
#define PLATEAU_LEAST_DIP 0.1

/* Tells whether it is as bright between a marker and the nearest other one as
 * at both: 1 or 0.
 *
 * bgr: height x width x 3 codes. places: count x 2, x and y in pixels; count is
 * 2 or more. sense: 1, or -1 for what is dark, where every code counts as its
 * difference to 255. */
int32_t plateau_on_one_thing(const uint8_t *bgr, int32_t height, int32_t width,
                             int32_t count, const double *places,
                             int32_t sense);

#endif
