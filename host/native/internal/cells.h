/* Images of cells, as the sources of the front end share them. */
#ifndef CELLS_H
#define CELLS_H

#include <float.h>
#include <stdbool.h>

#include "../front.h"

/* Rows of numbers; each row begins stride numbers after the one above it. */
typedef struct {
    float *first;
    int stride, rows, columns;
} image_t;

static inline int least(int a, int b)
{
    return a < b ? a : b;
}

static inline int most(int a, int b)
{
    return a > b ? a : b;
}

static inline float lesser(float a, float b)
{
    return a < b ? a : b;
}

static inline float greater(float a, float b)
{
    return a > b ? a : b;
}

static inline float *row_of(image_t image, int row)
{
    return image.first + row * image.stride;
}

/* One channel of three. */
static inline float *channel(const front_layout_t *layout, float *images,
                             int which)
{
    return images + which * layout->rows * layout->columns;
}

/* Index of the first cell of a scale. */
static inline int first_cell(const front_layout_t *layout, int scale)
{
    return layout->top[scale] * layout->columns + FRONT_BORDER;
}

/* The cells of one scale of an image. */
static inline image_t at_scale(const front_layout_t *layout, float *image,
                               int scale)
{
    return (image_t){image + first_cell(layout, scale), layout->columns,
                     layout->height[scale], layout->width[scale]};
}

/* Whether a channel of a cell may have been clipped. */
static inline bool is_clipped(float blue, float green, float red)
{
    return greater(blue, greater(green, red)) >= (float)FRONT_CLIPPED_LIGHT;
}

/* The least weight that counts in a cell.  Where a channel may have been
 * clipped the negative ones do not: that channel says only that there is as
 * much or more, and a lamp's core, which clips in more channels than its halo,
 * would otherwise be a hole in it. */
static inline float least_weight(float blue, float green, float red)
{
    return is_clipped(blue, green, red) ? 0.0F : -FLT_MAX;
}

/* Added light through weights, which count as the least one where they are
 * less. */
static inline float filtered(const float weights[3], float least_one,
                             float blue, float green, float red)
{
    return greater(weights[0], least_one) * blue +
           greater(weights[1], least_one) * green +
           greater(weights[2], least_one) * red;
}

/* Surrounds a scale of an image by its outermost cells. */
void cells_repeat_outermost(const front_layout_t *layout, float *image,
                            int scale);

/* Cells first to last, of the outermost of which only shares belong to it. */
typedef struct {
    int first, last;
    float head, tail;
} span_t;

/* Which of n cells make up the k-th of some equal parts, n of them or fewer. */
span_t cells_span(int k, int n, int parts);

/* How much of a cell belongs to a span, 0 to 1. */
float cells_share(const span_t *span, int cell);

/* Sums of n numbers over equal parts of the row, times a factor. */
void cells_sum_parts(const float *restrict in, int n, float *restrict out,
                     int parts, float factor);

/* What sums over the parts of an image have to be multiplied by for means. */
float cells_mean_factor(int rows, int columns, image_t out);

/* Means of the cells that fall into each cell of a smaller image.
 * sums: room for a row of the larger one. */
void cells_shrink(image_t in, image_t out, float *restrict sums);

/* A place between two samples. */
typedef struct {
    int before, after;
    float share; /* of the one after it */
} place_t;

/* As cells_place(), where a step is n over m. */
static inline place_t place_of(int i, float step, int n)
{
    const float at = greater(((float)i + 0.5F) * step - 0.5F, 0.0F);
    const int before = least((int)at, n - 1);
    return (place_t){before, least(before + 1, n - 1), at - (float)before};
}

/* Where the i-th of m places is between n samples that are spread as evenly
 * over the same length; before the first and beyond the last there is nothing.
 */
static inline place_t cells_place(int i, int m, int n)
{
    return place_of(i, (float)n / (float)m, n);
}

/* Draws each row of a small image out linearly to the columns of a larger one
 * with as many rows.  shares: room for one number for each of those columns. */
void cells_draw_out(image_t in, image_t out, float *restrict shares);

/* Numbers that an image and so many more at both ends of a row need for
 * smoothing. */
int cells_smooth_room(int rows, int columns);

/* Smooths an image in place by a Gaussian with a standard deviation of
 * 1.5 cells; it is mirrored at its outermost cells.
 * room: for cells_smooth_room() numbers. */
void cells_smooth(image_t image, float *room);

/* The k-th least of n values, from k = 0, which are put into another order. */
float cells_kth_least(float *values, int n, int k);

/* Fills in the light and the covariance of a frame, see front_respond(); false
 * if there is no memory. */
bool light_make(const front_frame_t *frame, const uint8_t *bgr, int pixels,
                const float *linear);

/* Fills in the filters of a frame from its covariance, see front_respond(). */
void filters_make(const front_frame_t *frame, const double *signatures);

#endif
