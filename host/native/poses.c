#include "poses.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* Coordinates of a pose: the place and a turn. */
enum { COORDINATES = 6 };

/* Of a fit; most take five, along the flat valley of a far plane it is slow. */
enum { MOST_ROUNDS = 100 };

/* A round that takes less than this off chi-square moves the pose by a
 * thirtieth of its error. */
#define CONVERGED 1e-3

#define LEAST_DAMPING 1e-9
#define FIRST_DAMPING 1e-3
#define MOST_DAMPING 1e6

/* What is known along each coordinate is taken to be more by so much: of one
 * that nothing is known of the step is none. */
#define LEAST_KNOWN 1e-12

/* Markers' depths in widths of the dock: nearer one is in the lens, farther the
 * dock is a point, and a search that came there ran away. */
#define NEAREST 1e-3
#define FARTHEST 1e4

/* Of the dock frame. */
static const double ORIGIN[3] = {0};

typedef struct {
    double R[9], t[3];
} pose_t;

/* The normal equations of one pose, and the sum of squared distances of the
 * markers in pixels. */
typedef struct {
    double information[COORDINATES][COORDINATES], gradient[COORDINATES];
    double chi_square, square_px;
} normal_t;

/* Solves A x = b by Gaussian elimination with partial pivoting; each row of the
 * matrix ends with its b.  The last column becomes x. */
static void solve(double A[COORDINATES][COORDINATES + 1])
{
    for (int k = 0; k < COORDINATES; k++) {
        int pivot = k;
        for (int i = k + 1; i < COORDINATES; i++)
            if (fabs(A[i][k]) > fabs(A[pivot][k]))
                pivot = i;
        double row[COORDINATES + 1];
        memcpy(row, A[pivot], sizeof row);
        memcpy(A[pivot], A[k], sizeof row);
        memcpy(A[k], row, sizeof row);
        for (int i = k + 1; i < COORDINATES; i++) {
            const double factor = A[i][k] / row[k];
            for (int j = k; j <= COORDINATES; j++)
                A[i][j] -= factor * row[j];
        }
    }
    for (int k = COORDINATES - 1; k >= 0; k--) {
        for (int j = k + 1; j < COORDINATES; j++)
            A[k][COORDINATES] -= A[k][j] * A[j][COORDINATES];
        A[k][COORDINATES] /= A[k][k];
    }
}

/* The rotation by a turn: Rodrigues' formula. */
static void rotation(const double *turn, double *R)
{
    const double angle =
        sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
    const double cosine = cos(angle), sine = sin(angle);
    double axis[3] = {0};
    for (int i = 0; i < 3 && angle > 0; i++)
        axis[i] = turn[i] / angle;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        R[4 * i] = cosine + (1 - cosine) * axis[i] * axis[i];
        R[3 * i + j] = (1 - cosine) * axis[i] * axis[j] - sine * axis[k];
        R[3 * j + i] = (1 - cosine) * axis[i] * axis[j] + sine * axis[k];
    }
}

/* Where a marker at arm from the dock's origin, in the camera's axes, is seen;
 * by: its derivatives by the pose.  Whether the lens sees it. */
static bool project(const lens_t *lens, const double *arm, const double *t,
                    double pixel[2], double by[2][COORDINATES])
{
    const double at[3] = {arm[0] + t[0], arm[1] + t[1], arm[2] + t[2]};
    double by_place[2][3];
    uint8_t seen;
    lens_sees(lens, 1, at, &seen);
    lens_project(lens, 1, at, pixel, by_place[0]);
    for (int axis = 0; axis < 2; axis++)
        for (int i = 0; i < 3; i++) {
            /* The arm turns: the vector product of it and the derivative. */
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            const double *along = by_place[axis];
            by[axis][i] = along[i];
            by[axis][3 + i] = arm[j] * along[k] - arm[k] * along[j];
        }
    return seen;
}

/* From the origin of the dock's frame to the marker, in the camera's axes. */
static void turned(const double *R, const double *point, const double *origin,
                   double arm[3])
{
    const double off[3] = {point[0] - origin[0], point[1] - origin[1],
                           point[2] - origin[2]};
    for (int i = 0; i < 3; i++)
        arm[i] =
            R[3 * i] * off[0] + R[3 * i + 1] * off[1] + R[3 * i + 2] * off[2];
}

/* The normal equations of a pose of the dock frame whose origin is at origin;
 * whether the lens sees all markers. */
static bool normal_of(const poses_sighting_t *sighting, const double *sigma,
                      const double *origin, const double *R, const double *t,
                      normal_t *normal)
{
    bool seen = true;
    *normal = (normal_t){0};
    for (int32_t marker = 0; marker < sighting->markers; marker++) {
        double arm[3], pixel[2], by[2][COORDINATES];
        turned(R, sighting->points + (ptrdiff_t)3 * marker, origin, arm);
        seen &= project(sighting->lens, arm, t, pixel, by);
        const double weight = 1 / (sigma[marker] * sigma[marker]);
        for (int axis = 0; axis < 2; axis++) {
            const double off =
                pixel[axis] - sighting->pixels[2 * marker + axis];
            for (int i = 0; i < COORDINATES; i++) {
                const double weighed = weight * by[axis][i];
                for (int j = 0; j < COORDINATES; j++)
                    normal->information[i][j] += weighed * by[axis][j];
                normal->gradient[i] += weighed * off;
            }
            normal->chi_square += weight * off * off;
            normal->square_px += off * off;
        }
    }
    return seen;
}

/* To where the sum of squared errors would be least if they were linear, damped
 * by that share of what is known along each coordinate. */
static pose_t stepped(const normal_t *normal, double damping,
                      const pose_t *pose)
{
    double A[COORDINATES][COORDINATES + 1];
    for (int i = 0; i < COORDINATES; i++) {
        memcpy(A[i], normal->information[i], sizeof normal->information[i]);
        A[i][i] += damping * (A[i][i] + LEAST_KNOWN);
        A[i][COORDINATES] = -normal->gradient[i];
    }
    solve(A);
    double turn[3], by[9];
    pose_t after;
    for (int i = 0; i < 3; i++) {
        after.t[i] = pose->t[i] + A[i][COORDINATES];
        turn[i] = A[3 + i][COORDINATES];
    }
    rotation(turn, by);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            after.R[3 * i + j] = by[3 * i] * pose->R[j] +
                                 by[3 * i + 1] * pose->R[3 + j] +
                                 by[3 * i + 2] * pose->R[6 + j];
    return after;
}

/* Downhill from a pose about the markers' centroid; whether it came to a
 * minimum. */
static bool descend(const poses_sighting_t *sighting, const double *sigma,
                    const double *centroid, pose_t *pose)
{
    normal_t now, after;
    if (!normal_of(sighting, sigma, centroid, pose->R, pose->t, &now))
        return false;
    double damping = FIRST_DAMPING;
    for (int round = 0; round < MOST_ROUNDS; round++) {
        const pose_t next = stepped(&now, damping, pose);
        if (normal_of(sighting, sigma, centroid, next.R, next.t, &after) &&
            after.chi_square <= now.chi_square) {
            const double gained = now.chi_square - after.chi_square;
            *pose = next;
            now = after;
            damping = fmax(damping / 10, LEAST_DAMPING);
            if (gained < CONVERGED)
                return true;
        } else {
            damping *= 10;
            if (damping > MOST_DAMPING)
                return true;
        }
    }
    return false;
}

/* Whether all markers of a pose are at depths that a dock can be at. */
static bool is_somewhere(const poses_sighting_t *sighting, const pose_t *pose)
{
    double least[3] = {INFINITY, INFINITY, INFINITY};
    double most[3] = {-INFINITY, -INFINITY, -INFINITY};
    double nearest = INFINITY, farthest = -INFINITY;
    for (int32_t marker = 0; marker < sighting->markers; marker++) {
        const double *point = sighting->points + (ptrdiff_t)3 * marker;
        double at[3], depth;
        turned(pose->R, point, ORIGIN, at);
        for (int i = 0; i < 3; i++) {
            at[i] += pose->t[i];
            least[i] = fmin(least[i], point[i]);
            most[i] = fmax(most[i], point[i]);
        }
        lens_depth(sighting->lens, 1, at, &depth);
        nearest = fmin(nearest, depth);
        farthest = fmax(farthest, depth);
    }
    const double width =
        fmax(fmax(most[0] - least[0], most[1] - least[1]), most[2] - least[2]);
    return nearest > NEAREST * width && farthest < FARTHEST * width;
}

int32_t poses_refine(const poses_sighting_t *sighting, const double *sigma,
                     double *R, double *t, double *information,
                     poses_fit_t *fit)
{
    double centroid[3] = {0}, arm[3];
    for (int32_t marker = 0; marker < sighting->markers; marker++)
        for (int i = 0; i < 3; i++)
            centroid[i] += sighting->points[3 * marker + i] / sighting->markers;
    pose_t pose;
    memcpy(pose.R, R, sizeof pose.R);
    turned(pose.R, centroid, ORIGIN, arm);
    for (int i = 0; i < 3; i++)
        pose.t[i] = t[i] + arm[i];
    if (!descend(sighting, sigma, centroid, &pose))
        return 0;
    turned(pose.R, centroid, ORIGIN, arm);
    for (int i = 0; i < 3; i++)
        pose.t[i] -= arm[i];
    if (!is_somewhere(sighting, &pose))
        return 0;
    normal_t normal;
    normal_of(sighting, sigma, ORIGIN, pose.R, pose.t, &normal);
    memcpy(R, pose.R, sizeof pose.R);
    memcpy(t, pose.t, sizeof pose.t);
    memcpy(information, normal.information, sizeof normal.information);
    fit->chi_square = normal.chi_square;
    fit->reprojection_px = sqrt(normal.square_px / sighting->markers);
    return 1;
}

void poses_rotations(int32_t count, const double *turns, double *R)
{
    for (ptrdiff_t i = 0; i < count; i++)
        rotation(turns + 3 * i, R + 9 * i);
}

int32_t poses_project(const lens_t *lens, int32_t markers, const double *points,
                      const double *R, const double *t, double *pixels,
                      double *jacobian)
{
    bool seen = true;
    for (ptrdiff_t marker = 0; marker < markers; marker++) {
        double arm[3], by[2][COORDINATES];
        turned(R, points + 3 * marker, ORIGIN, arm);
        seen &= project(lens, arm, t, pixels + 2 * marker, by);
        memcpy(jacobian + 2 * COORDINATES * marker, by, sizeof by);
    }
    return seen;
}

void poses_normal(const poses_sighting_t *sighting, int32_t count,
                  const double *R, const double *t, const double *sigma,
                  double *information, double *gradient, double *chi_square,
                  uint8_t *seen)
{
    for (ptrdiff_t i = 0; i < count; i++) {
        normal_t normal;
        seen[i] = normal_of(sighting, sigma + i * sighting->markers, ORIGIN,
                            R + 9 * i, t + 3 * i, &normal);
        memcpy(information, normal.information, sizeof normal.information);
        memcpy(gradient, normal.gradient, sizeof normal.gradient);
        information += COORDINATES * COORDINATES;
        gradient += COORDINATES;
        chi_square[i] = normal.chi_square;
    }
}
