/* What the fits of poses to markers compute of many poses, or many times.
 *
 * A turn is a rotation vector about the camera's axes, radians.  Nothing here
 * allocates memory or keeps anything between two calls; all arrays belong to
 * the caller. Calls from several threads are independent. */
#ifndef POSES_H
#define POSES_H

#include <stdint.h>

/* Rotations, count x 3 x 3, by count turns. */
void poses_rotations(int32_t count, const double *turns, double *R);

/* Reprojection errors in standard deviations, and their derivatives by the
 * place and the turn of a pose.
 *
 * For poses x markers: arms: x, y, z of each marker from the dock's origin, by
 * the camera's axes; pixels: x, y where it is seen; by_place: 2 x 3, their
 * derivatives by where it is.  For the markers: measured: x, y in pixels;
 * sigma: standard deviations of both.
 * error: receives poses x 2 markers; jacobian: poses x 2 markers x 6. */
void poses_errors(int32_t poses, int32_t markers, const double *arms,
                  const double *pixels, const double *by_place,
                  const double *measured, const double *sigma, double *error,
                  double *jacobian);

/* The step of Levenberg and Marquardt's method from one pose: to where the sum
 * of squared errors would be least if they were linear, damped by that share of
 * what is known along each coordinate.
 *
 * rows: errors; error, jacobian: as above, of one pose; R: 3 x 3, t: 3: the
 * pose.  R_after, t_after: receive the pose after the step. */
void poses_step(int32_t rows, const double *error, const double *jacobian,
                double damping, const double *R, const double *t,
                double *R_after, double *t_after);

#endif
