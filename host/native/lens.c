#include "lens.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* Metres: of what is not in front of a flat picture, but has to have some place
 * in it. */
#define SOME_DEPTH 1e-3

/* Of the distance: what is nearer to the axis is on it. */
#define ON_AXIS 1e-12

/* Newton's method ends with a step of so many focal lengths, or after so many
 * rounds: three to five take it to the last bit. */
#define CONVERGED 1e-13
enum { MOST_ROUNDS = 20 };

/* A place in focal lengths, and its derivatives by the point. */
typedef struct {
    double at[2], by[2][3];
} place_t;

/* OpenCV's formula: a rational polynomial along the radius, tangential terms
 * and those of a thin prism. */
static void distort(const double *k, double x, double y, double at[2],
                    double by[2][2])
{
    const double u = x * x + y * y;
    const double over = 1 + u * (k[0] + u * (k[1] + u * k[4]));
    const double under = 1 + u * (k[5] + u * (k[6] + u * k[7]));
    const double over_slope = k[0] + u * (2 * k[1] + u * 3 * k[4]);
    const double under_slope = k[5] + u * (2 * k[6] + u * 3 * k[7]);
    const double radial = over / under;
    const double slope = 2 * (over_slope - radial * under_slope) / under;
    const double prism[2] = {2 * (k[8] + 2 * u * k[9]),
                             2 * (k[10] + 2 * u * k[11])};
    at[0] = x * radial + 2 * k[2] * x * y + k[3] * (u + 2 * x * x) +
            u * (k[8] + u * k[9]);
    at[1] = y * radial + 2 * k[3] * x * y + k[2] * (u + 2 * y * y) +
            u * (k[10] + u * k[11]);
    const double across = slope * x * y + 2 * (k[2] * x + k[3] * y);
    by[0][0] =
        radial + slope * x * x + 2 * k[2] * y + 6 * k[3] * x + prism[0] * x;
    by[0][1] = across + prism[0] * y;
    by[1][0] = across + prism[1] * x;
    by[1][1] =
        radial + slope * y * y + 6 * k[2] * y + 2 * k[3] * x + prism[1] * y;
}

static place_t in_pinhole(const lens_t *lens, const double *point)
{
    const double z = point[2] > 0 ? point[2] : SOME_DEPTH;
    const double x = point[0] / z, y = point[1] / z;
    double bent[2], by_bent[2][2];
    distort(lens->coefficients, x, y, bent, by_bent);
    double tilted[3];
    for (int i = 0; i < 3; i++) {
        const double *row = lens->tilt + (ptrdiff_t)3 * i;
        tilted[i] = row[0] * bent[0] + row[1] * bent[1] + row[2];
    }
    place_t place;
    for (int axis = 0; axis < 2; axis++) {
        const double at = tilted[axis] / tilted[2];
        double by_ideal[2] = {0};
        for (int i = 0; i < 2; i++) {
            const double by =
                (lens->tilt[3 * axis + i] - at * lens->tilt[6 + i]) / tilted[2];
            by_ideal[0] += by * by_bent[i][0];
            by_ideal[1] += by * by_bent[i][1];
        }
        place.at[axis] = at;
        place.by[axis][0] = by_ideal[0] / z;
        place.by[axis][1] = by_ideal[1] / z;
        place.by[axis][2] = -(by_ideal[0] * x + by_ideal[1] * y) / z;
    }
    return place;
}

static double bend(const double *k, double angle, double *slope)
{
    const double u = angle * angle;
    *slope =
        1 + u * (3 * k[0] + u * (5 * k[1] + u * (7 * k[2] + u * 9 * k[3])));
    return angle * (1 + u * (k[0] + u * (k[1] + u * (k[2] + u * k[3]))));
}

/* The angle to the axis. */
static double off_axis(const double *point)
{
    return atan2(hypot(point[0], point[1]), point[2]);
}

static place_t in_equidistant(const lens_t *lens, const double *point)
{
    const double x = point[0], y = point[1], z = point[2];
    const double across = hypot(x, y);
    double slope;
    const double bent = bend(lens->coefficients, off_axis(point), &slope);
    const double square = fmax(across * across + z * z, ON_AXIS * ON_AXIS);
    const bool on_axis = across < ON_AXIS * sqrt(square);
    const double c = on_axis ? 1 : x / across, s = on_axis ? 0 : y / across;
    /* Across the line to the principal point, and along it. */
    const double around = on_axis ? 1 / sqrt(square) : bent / across;
    const double along = slope * z / square;
    const double both = (along - around) * c * s;
    return (place_t){
        .at = {bent * c, bent * s},
        .by = {{along * c * c + around * s * s, both, -slope * x / square},
               {both, along * s * s + around * c * c, -slope * y / square}},
    };
}

void lens_project(const lens_t *lens, int32_t count, const double *points,
                  double *pixels, double *by_place)
{
    for (int32_t i = 0; i < count; i++) {
        const place_t place = lens->kind == LENS_EQUIDISTANT
                                  ? in_equidistant(lens, points)
                                  : in_pinhole(lens, points);
        for (int axis = 0; axis < 2; axis++) {
            const double focal = lens->focal[axis];
            *pixels++ = focal * place.at[axis] + lens->centre[axis];
            for (int j = 0; j < 3; j++)
                *by_place++ = focal * place.by[axis][j];
        }
        points += 3;
    }
}

void lens_straighten(const lens_t *lens, int32_t count, const double *pixels,
                     double *ideal)
{
    for (int32_t i = 0; i < count; i++) {
        double given[2], point[3] = {0, 0, 1};
        for (int axis = 0; axis < 2; axis++) {
            given[axis] =
                (*pixels++ - lens->centre[axis]) * (1 / lens->focal[axis]);
            point[axis] = given[axis];
        }
        for (int round = 0; round < MOST_ROUNDS; round++) {
            const place_t place = in_pinhole(lens, point);
            const double (*by)[3] = place.by;
            const double x = given[0] - place.at[0], y = given[1] - place.at[1];
            const double area = by[0][0] * by[1][1] - by[0][1] * by[1][0];
            if (!(area > 0))
                break;
            const double right = (by[1][1] * x - by[0][1] * y) / area;
            const double down = (by[0][0] * y - by[1][0] * x) / area;
            point[0] += right;
            point[1] += down;
            if (fabs(right) + fabs(down) < CONVERGED)
                break;
        }
        *ideal++ = point[0];
        *ideal++ = point[1];
    }
}

void lens_sees(const lens_t *lens, int32_t count, const double *points,
               uint8_t *seen)
{
    for (int32_t i = 0; i < count; i++) {
        const double *point = points + (ptrdiff_t)3 * i;
        if (lens->kind == LENS_EQUIDISTANT)
            seen[i] = off_axis(point) < lens->widest;
        else
            seen[i] = point[2] > 0 &&
                      hypot(point[0], point[1]) < lens->widest * point[2];
    }
}

void lens_depth(const lens_t *lens, int32_t count, const double *points,
                double *depth)
{
    for (int32_t i = 0; i < count; i++) {
        const double *point = points + (ptrdiff_t)3 * i;
        depth[i] = lens->kind == LENS_EQUIDISTANT
                       ? sqrt(point[0] * point[0] + point[1] * point[1] +
                              point[2] * point[2])
                       : point[2];
    }
}

void lens_bend(const double *coefficients, int32_t count, const double *angles,
               double *bent, double *slope)
{
    for (int32_t i = 0; i < count; i++)
        bent[i] = bend(coefficients, angles[i], slope + i);
}
