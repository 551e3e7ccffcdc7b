/* Lenses: where a point is in the picture, and how its place moves with it.
 *
 * `chromadock.lens` says which there are, and inverts them.  Points are x, y,
 * z in metres, camera frame; no function keeps anything, and calls from
 * several threads are independent. */
#ifndef LENS_H
#define LENS_H

#include <stdint.h>

#define LENS_PINHOLE 0
#define LENS_EQUIDISTANT 1

/* kind: one of the above; focal, centre: pixels, across and down.
 * coefficients: as OpenCV orders them for that kind, 0 where not given; of a
 * pinhole those of a tilted sensor are in tilt: 3 x 3, what it does to a
 * distorted place (x, y, 1).
 * widest: points are seen below this angle to the axis: of a pinhole its
 * tangent. */
typedef struct {
    int32_t kind;
    double focal[2], centre[2];
    double coefficients[12];
    double tilt[9];
    double widest;
} lens_t;

/* Tells of each point whether it has a place in the picture, however large the
 * picture: 1 or 0. */
void lens_sees(const lens_t *lens, int32_t count, const double *points,
               uint8_t *seen);

/* pixels: receives count x 2; by_place: count x 2 x 3, their derivatives by the
 * point.  What is not in front of a pinhole has some place, too: that of a
 * point a millimetre before it. */
void lens_project(const lens_t *lens, int32_t count, const double *points,
                  double *pixels, double *by_place);

/* The other way: ideal: receives count x 2, where a pinhole without
 * coefficients would have what this one has at pixels, count x 2, in focal
 * lengths.  Pixels are those of places before the formula turns back. */
void lens_straighten(const lens_t *lens, int32_t count, const double *pixels,
                     double *ideal);

/* depth: receives what a thing's size in the picture is in proportion to 1 /
 * of: of a pinhole the distance along the axis, else the distance. */
void lens_depth(const lens_t *lens, int32_t count, const double *points,
                double *depth);

/* bent: receives theta_d of each angle to the axis, radians, of an equidistant
 * lens with those four coefficients, which is the distance from the principal
 * point in focal lengths; slope: its derivative. */
void lens_bend(const double *coefficients, int32_t count, const double *angles,
               double *bent, double *slope);

#endif
