#include "poses.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* Coordinates of a pose: the place and a turn. */
enum { COORDINATES = 6 };

/* What is known along each coordinate is taken to be more by so much: of one
 * that nothing is known of the step is none. */
#define LEAST_KNOWN 1e-12

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

void poses_rotations(int32_t count, const double *turns, double *R)
{
    for (ptrdiff_t i = 0; i < count; i++)
        rotation(turns + 3 * i, R + 9 * i);
}

void poses_errors(int32_t poses, int32_t markers, const double *arms,
                  const double *pixels, const double *by_place,
                  const double *measured, const double *sigma, double *error,
                  double *jacobian)
{
    for (int32_t pose = 0; pose < poses; pose++)
        for (int32_t marker = 0; marker < markers; marker++) {
            const double *place = measured + (ptrdiff_t)2 * marker;
            for (int axis = 0; axis < 2; axis++) {
                error[axis] = (pixels[axis] - place[axis]) / sigma[marker];
                const double *by = by_place + (ptrdiff_t)3 * axis;
                double *row = jacobian + (ptrdiff_t)6 * axis;
                for (int i = 0; i < 3; i++) {
                    /* The arm turns: the vector product of it and by. */
                    const int j = (i + 1) % 3, k = (i + 2) % 3;
                    const double turned = arms[j] * by[k] - arms[k] * by[j];
                    row[i] = by[i] / sigma[marker];
                    row[3 + i] = turned / sigma[marker];
                }
            }
            arms += 3;
            pixels += 2;
            by_place += 6;
            error += 2;
            jacobian += 12;
        }
}

void poses_step(int32_t rows, const double *error, const double *jacobian,
                double damping, const double *R, const double *t,
                double *R_after, double *t_after)
{
    double normal[COORDINATES][COORDINATES + 1] = {{0}};
    for (int32_t row = 0; row < rows; row++) {
        const double *by = jacobian + (ptrdiff_t)COORDINATES * row;
        for (int i = 0; i < COORDINATES; i++) {
            for (int j = 0; j < COORDINATES; j++)
                normal[i][j] += by[i] * by[j];
            normal[i][COORDINATES] -= by[i] * error[row];
        }
    }
    for (int i = 0; i < COORDINATES; i++)
        normal[i][i] += damping * (normal[i][i] + LEAST_KNOWN);
    solve(normal);
    double turn[3], turned[9];
    for (int i = 0; i < 3; i++) {
        t_after[i] = t[i] + normal[i][COORDINATES];
        turn[i] = normal[3 + i][COORDINATES];
    }
    rotation(turn, turned);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            R_after[3 * i + j] = turned[3 * i] * R[j] +
                                 turned[3 * i + 1] * R[3 + j] +
                                 turned[3 * i + 2] * R[6 + j];
}
