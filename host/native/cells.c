#include "internal/cells.h"
#include "internal/vectors.h"

#include <math.h>
#include <string.h>

/* Smoothing has a standard deviation of so many cells, and ends at so many. */
#define SMOOTHING 1.5
#define REACH 6

void cells_repeat_outermost(const front_layout_t *layout, float *image,
                            int scale)
{
    const image_t inner = at_scale(layout, image, scale);
    for (int y = 0; y < inner.rows; y++) {
        float *row = row_of(inner, y);
        for (int x = 1; x <= FRONT_BORDER; x++) {
            row[-x] = row[0];
            row[inner.columns - 1 + x] = row[inner.columns - 1];
        }
    }
    const size_t whole =
        (size_t)(inner.columns + 2 * FRONT_BORDER) * sizeof(float);
    for (int y = 1; y <= FRONT_BORDER; y++) {
        memcpy(row_of(inner, -y) - FRONT_BORDER,
               row_of(inner, 0) - FRONT_BORDER, whole);
        memcpy(row_of(inner, inner.rows - 1 + y) - FRONT_BORDER,
               row_of(inner, inner.rows - 1) - FRONT_BORDER, whole);
    }
}

span_t cells_span(int k, int n, int parts)
{
    const int begin = k * n, end = begin + n; /* in cells over parts */
    const int first = begin / parts, last = (end - 1) / parts;
    const float unit = 1.0F / (float)parts;
    return (span_t){first, last, unit * (float)((first + 1) * parts - begin),
                    unit * (float)(end - last * parts)};
}

float cells_share(const span_t *span, int cell)
{
    if (cell == span->first)
        return span->head;
    return cell == span->last ? span->tail : 1.0F;
}

WIDE_VECTORS void cells_sum_parts(const float *restrict in, int n,
                                  float *restrict out, int parts, float factor)
{
    if (n == 2 * parts) {
        for (int k = 0; k < parts; k++)
            out[k] = factor * (in[2 * k] + in[2 * k + 1]);
        return;
    }
    const int wide = n / parts;
    span_t span = cells_span(0, n, parts);
    for (int k = 0; k < parts; k++) {
        /* Parts of whole cells differ in where they begin alone. */
        if (n == wide * parts)
            span.first = k * wide, span.last = span.first + wide - 1;
        else
            span = cells_span(k, n, parts);
        float sum = span.head * in[span.first];
        for (int x = span.first + 1; x < span.last; x++)
            sum += in[x];
        if (span.last > span.first)
            sum += span.tail * in[span.last];
        out[k] = factor * sum;
    }
}

float cells_mean_factor(int rows, int columns, image_t out)
{
    return (float)out.rows / (float)rows * (float)out.columns / (float)columns;
}

/* Means of 2 x 2 cells. */
WIDE_VECTORS static void halve(image_t in, image_t out)
{
    for (int k = 0; k < out.rows; k++) {
        const float *restrict above = row_of(in, 2 * k);
        const float *restrict below = row_of(in, 2 * k + 1);
        float *restrict to = row_of(out, k);
        for (int x = 0; x < out.columns; x++)
            to[x] = 0.25F * (above[2 * x] + below[2 * x] +
                             (above[2 * x + 1] + below[2 * x + 1]));
    }
}

WIDE_VECTORS void cells_shrink(image_t in, image_t out, float *restrict sums)
{
    if (in.rows == 2 * out.rows && in.columns == 2 * out.columns) {
        halve(in, out);
        return;
    }
    const float factor = cells_mean_factor(in.rows, in.columns, out);
    for (int k = 0; k < out.rows; k++) {
        const span_t span = cells_span(k, in.rows, out.rows);
        memset(sums, 0, (size_t)in.columns * sizeof(float));
        for (int y = span.first; y <= span.last; y++) {
            const float share = cells_share(&span, y);
            const float *restrict row = row_of(in, y);
            for (int x = 0; x < in.columns; x++)
                sums[x] += share * row[x];
        }
        cells_sum_parts(sums, in.columns, row_of(out, k), out.columns, factor);
    }
}

WIDE_VECTORS void cells_draw_out(image_t in, image_t out,
                                 float *restrict shares)
{
    const float step = (float)in.columns / (float)out.columns;
    for (int x = 0; x < out.columns; x++)
        shares[x] = place_of(x, step, in.columns).share;
    /* A column at a time, for all that lies between it and the next one is
     * on one straight line in each row. */
    for (int k = 0, first = 0, end; k < in.columns; k++, first = end) {
        for (end = first; end < out.columns; end++)
            if (place_of(end, step, in.columns).before > k)
                break;
        const int after = least(k + 1, in.columns - 1);
        for (int y = 0; y < in.rows; y++) {
            const float here = row_of(in, y)[k];
            const float rise = row_of(in, y)[after] - here;
            float *restrict to = row_of(out, y);
            for (int x = first; x < end; x++)
                to[x] = here + shares[x] * rise;
        }
    }
}

int cells_smooth_room(int rows, int columns)
{
    return (rows + 2 * REACH + 1) * columns + 2 * REACH;
}

/* Index of a row or column that is as far inside n as i is outside. */
static int mirrored(int i, int n)
{
    while (n > 1 && (i < 0 || i >= n))
        i = i < 0 ? -i : 2 * (n - 1) - i;
    return n > 1 ? i : 0;
}

/* One row of n smoothed values: from the values of in that are 0, 1, 2 ...
 * times so many numbers on, REACH before each and REACH after it. */
static inline void smooth_line(const float kernel[2 * REACH + 1],
                               const float *restrict in, int apart, int n,
                               float *restrict out)
{
    for (int x = 0; x < n; x++) {
        float sum = 0;
        for (int i = 0; i <= 2 * REACH; i++)
            sum += kernel[i] * in[x + i * apart];
        out[x] = sum;
    }
}

WIDE_VECTORS void cells_smooth(image_t image, float *room)
{
    float kernel[2 * REACH + 1], sum = 0;
    for (int i = -REACH; i <= REACH; i++)
        sum += kernel[i + REACH] =
            (float)exp(-0.5 * i * i / (SMOOTHING * SMOOTHING));
    for (int i = 0; i <= 2 * REACH; i++)
        kernel[i] /= sum;
    const int rows = image.rows, columns = image.columns;
    const size_t row_size = (size_t)columns * sizeof(float);
    /* The image smoothed along its rows, with REACH rows more at both ends. */
    const image_t across = {room + REACH * columns, columns, rows, columns};
    float *wide = room + (rows + 2 * REACH) * columns;
    for (int y = 0; y < rows; y++) {
        const float *from = row_of(image, y);
        memcpy(wide + REACH, from, row_size);
        for (int i = 1; i <= REACH; i++) {
            wide[REACH - i] = from[mirrored(-i, columns)];
            wide[REACH + columns - 1 + i] =
                from[mirrored(columns - 1 + i, columns)];
        }
        smooth_line(kernel, wide, 1, columns, row_of(across, y));
    }
    for (int i = 1; i <= REACH; i++) {
        memcpy(row_of(across, -i), row_of(across, mirrored(-i, rows)),
               row_size);
        memcpy(row_of(across, rows - 1 + i),
               row_of(across, mirrored(rows - 1 + i, rows)), row_size);
    }
    for (int y = 0; y < rows; y++)
        smooth_line(kernel, row_of(across, y - REACH), columns, columns,
                    row_of(image, y));
}

/* Puts the numbers that are less than a pivot, or no more than it if it belongs
 * to them itself, before the others; returns how many they are.  Without a
 * branch, for nobody could foretell it. */
static int put_first(float *values, int n, float pivot, bool itself)
{
    int count = 0;
    for (int i = 0; i < n; i++) {
        const float value = values[i];
        values[i] = values[count];
        values[count] = value;
        count += (value < pivot) | (itself & (value <= pivot));
    }
    return count;
}

/* Hoare's FIND, by three parts: less, as much, and more. */
float cells_kth_least(float *values, int n, int k)
{
    for (;;) {
        const float pivot = values[k];
        const int less = put_first(values, n, pivot, false);
        if (k < less) {
            n = less;
            continue;
        }
        const int equal = put_first(values + less, n - less, pivot, true);
        if (k < less + equal)
            return pivot;
        values += less + equal;
        n -= less + equal;
        k -= less + equal;
    }
}
