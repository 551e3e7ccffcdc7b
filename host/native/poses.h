/* Poses of markers that were seen: what their errors say of a pose, and the
 * pose that fits.
 *
 * A pose is R, 3 x 3, and t, 3, metres: T_camera_dock.  What is told by six
 * coordinates is told by its place x, y, z and a small turn about the camera's
 * axes through the dock's origin; a turn is a rotation vector, radians.
 * Nothing here allocates memory or keeps anything between two calls; all
 * arrays belong to the caller. Calls from several threads are independent. */
#ifndef POSES_H
#define POSES_H

#include <stdint.h>

#include "lens.h"

/* points: markers x 3, metres, dock frame; pixels: markers x 2, where each was
 * seen. */
typedef struct {
    const lens_t *lens;
    int32_t markers;
    const double *points, *pixels;
} poses_sighting_t;

/* Rotations, count x 3 x 3, by count turns. */
void poses_rotations(int32_t count, const double *turns, double *R);

/* Where markers at points, markers x 3, are seen at a pose.
 *
 * pixels: receives markers x 2; jacobian: markers x 2 x 6, their derivatives
 * by the pose.  Returns 1, or 0 where the lens does not see all of them. */
int32_t poses_project(const lens_t *lens, int32_t markers, const double *points,
                      const double *R, const double *t, double *pixels,
                      double *jacobian);

/* The normal equations of count poses: of the reprojection errors e in standard
 * deviations, with their derivatives J by the pose.
 *
 * sigma: poses x markers, standard deviations in pixels.  information: receives
 * count x 6 x 6, J'J; gradient: count x 6, J'e; chi_square: count, e'e; seen:
 * for each 1, or 0 where the lens does not see all markers. */
void poses_normal(const poses_sighting_t *sighting, int32_t count,
                  const double *R, const double *t, const double *sigma,
                  double *information, double *gradient, double *chi_square,
                  uint8_t *seen);

/* What a fit ends with: the sum of squared errors in standard deviations, and
 * the root mean square distance of the reprojected markers, pixels. */
typedef struct {
    double chi_square, reprojection_px;
} poses_fit_t;

/* The minimum of chi-square downhill of a pose, by Levenberg and Marquardt's
 * method.
 *
 * Searched about the markers' centroid, about which place and turn are about
 * independent: where the dock frame has its origin does not matter.
 * sigma: for each marker; R, t: the pose to start from, replaced.
 * information: receives 6 x 6, J'J as above.
 * Returns 1, or 0 where a marker would be out of view, none is reached in so
 * many rounds (the way there leads through poses that hardly fit), or it has a
 * marker in the lens or all in one point. */
int32_t poses_refine(const poses_sighting_t *sighting, const double *sigma,
                     double *R, double *t, double *information,
                     poses_fit_t *fit);

#endif
