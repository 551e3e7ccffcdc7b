#include "front.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Neighbours at this lag, in finest cells, share neither a marker nor JPEG's
 * blocks of 8 pixels. */
#define LAG 2
/* The fluctuation is measured on one row in so many: 2,300 cells fix six
 * numbers to 3%. */
#define ROW_STEP 8
/* Differences beyond so many times their mean are edges and lamps.  What
 * fluctuates a little more than noise, foam and caustics, counts: the filter
 * had better be blind to its colour as well. */
#define EDGE 2.5F
/* Variance of linear light that 8 bits leave in dark water:
 * (2.2 * 0.05^1.2 / 255)^2 / 12. */
#define QUANTUM 5e-9

/* The local noise is the mean of blocks of so many cells squared, ... */
#define BLOCK 8
/* ... at least and at most so many times the frame's median: no less than that
 * of almost all the frame, no more than what markers themselves may raise it
 * to. */
#define LEAST_NOISE 0.9F
#define MOST_NOISE 2.5F
/* Filtered light: no frame has less noise than this. */
#define NO_NOISE 1e-3F
/* It is smoothed by a Gaussian with a standard deviation of so many blocks, cut
 * off at so many. */
#define SMOOTHING 1.5
#define REACH 6
/* Standard deviation over mean absolute value of a normal variable. */
#define NORMAL 1.2533141F

/* A lamp between four cells has half its signal to noise in each; noise would
 * seldom add more. */
#define CELL_SHARE 0.7
/* Peaks that are looked at closely, of all scales. */
#define MAX_SUMMITS (3 * FRONT_MAX_PEAKS)
/* Cells within which a peak may belong to a higher one, and into how many parts
 * the way there is cut. */
#define NEARBY 12
#define PARTS 8
/* Clutter grows rarer with about this power of its strength. */
#define WORTH 2.0
/* Log likelihood ratio: less is kept by no lamp that matters. */
#define LEAST_LIKENESS -5.0

/* Rows of numbers, so many of them apart. */
typedef struct {
    float *first;
    int stride, rows, columns;
} image_t;

static int least(int a, int b)
{
    return a < b ? a : b;
}

static int most(int a, int b)
{
    return a > b ? a : b;
}

static float lesser(float a, float b)
{
    return a < b ? a : b;
}

static float greater(float a, float b)
{
    return a > b ? a : b;
}

static float *row_of(image_t image, int row)
{
    return image.first + row * image.stride;
}

/* One channel of three. */
static float *channel(const front_layout_t *layout, float *images, int which)
{
    return images + which * layout->rows * layout->columns;
}

/* Index of the first cell of a scale. */
static int first_cell(const front_layout_t *layout, int scale)
{
    return layout->top[scale] * layout->columns + FRONT_BORDER;
}

static image_t at_scale(const front_layout_t *layout, float *image, int scale)
{
    return (image_t){image + first_cell(layout, scale), layout->columns,
                     layout->height[scale], layout->width[scale]};
}

/* Surrounds a scale by its outermost cells; the rest of its rows is 0. */
static void repeat_outermost(const front_layout_t *layout, float *image,
                             int scale)
{
    const image_t inner = at_scale(layout, image, scale);
    const int rest = inner.stride - inner.columns - 2 * FRONT_BORDER;
    for (int y = 0; y < inner.rows; y++) {
        float *row = row_of(inner, y);
        for (int x = 1; x <= FRONT_BORDER; x++) {
            row[-x] = row[0];
            row[inner.columns - 1 + x] = row[inner.columns - 1];
        }
        memset(row + inner.columns + FRONT_BORDER, 0,
               (size_t)rest * sizeof(float));
    }
    const size_t whole = (size_t)inner.stride * sizeof(float);
    for (int y = 1; y <= FRONT_BORDER; y++) {
        memcpy(row_of(inner, -y) - FRONT_BORDER,
               row_of(inner, 0) - FRONT_BORDER, whole);
        memcpy(row_of(inner, inner.rows - 1 + y) - FRONT_BORDER,
               row_of(inner, inner.rows - 1) - FRONT_BORDER, whole);
    }
}

/* ---- Smaller and larger images ---- */

/* Cells first to last, of the outermost of which only shares belong to it. */
typedef struct {
    int first, last;
    float head, tail;
} span_t;

/* Which of n cells make up the k-th of some equal parts, n of them or fewer. */
static span_t span_of(int k, int n, int parts)
{
    const int begin = k * n, end = begin + n; /* in cells over parts */
    const int first = begin / parts, last = (end - 1) / parts;
    const float unit = 1.0F / (float)parts;
    return (span_t){first, last, unit * (float)((first + 1) * parts - begin),
                    unit * (float)(end - last * parts)};
}

static float share_of(const span_t *span, int cell)
{
    if (cell == span->first)
        return span->head;
    return cell == span->last ? span->tail : 1.0F;
}

/* Sums of n numbers over equal parts of the row, times a factor. */
static void sum_parts(const float *restrict in, int n, float *restrict out,
                      int parts, float factor)
{
    if (n == 2 * parts) {
        for (int k = 0; k < parts; k++)
            out[k] = factor * (in[2 * k] + in[2 * k + 1]);
        return;
    }
    for (int k = 0; k < parts; k++) {
        const span_t span = span_of(k, n, parts);
        float sum = span.head * in[span.first];
        for (int x = span.first + 1; x < span.last; x++)
            sum += in[x];
        if (span.last > span.first)
            sum += span.tail * in[span.last];
        out[k] = factor * sum;
    }
}

/* What the sum over a part has to be multiplied by for the mean. */
static float mean_factor(int rows, int columns, image_t out)
{
    return (float)out.rows / (float)rows * (float)out.columns / (float)columns;
}

/* Means of the cells that fall into each of a smaller image; sums: a row. */
static void shrink(image_t in, image_t out, float *restrict sums)
{
    const float factor = mean_factor(in.rows, in.columns, out);
    for (int k = 0; k < out.rows; k++) {
        const span_t span = span_of(k, in.rows, out.rows);
        memset(sums, 0, (size_t)in.columns * sizeof(float));
        for (int y = span.first; y <= span.last; y++) {
            const float share = share_of(&span, y);
            const float *restrict row = row_of(in, y);
            for (int x = 0; x < in.columns; x++)
                sums[x] += share * row[x];
        }
        sum_parts(sums, in.columns, row_of(out, k), out.columns, factor);
    }
}

/* A place between two samples. */
typedef struct {
    int before, after;
    float share; /* of the one after it */
} place_t;

/* Where the i-th of m places is between n samples that are spread as evenly
 * over the same length; before the first and beyond the last there is nothing.
 */
static place_t place_of(int i, int m, int n)
{
    const float at = ((float)i + 0.5F) * (float)n / (float)m - 0.5F;
    if (at <= 0.0F)
        return (place_t){0, 0, 0.0F};
    const int before = least((int)at, n - 1);
    return (place_t){before, least(before + 1, n - 1), at - (float)before};
}

/* Each row of a small image drawn out linearly to the columns of a larger one
 * with as many rows; places: one for each of those columns. */
static void draw_out(image_t in, image_t out, place_t *restrict places)
{
    for (int x = 0; x < out.columns; x++)
        places[x] = place_of(x, out.columns, in.columns);
    for (int y = 0; y < in.rows; y++) {
        const float *restrict from = row_of(in, y);
        float *restrict to = row_of(out, y);
        for (int x = 0; x < out.columns; x++) {
            const place_t p = places[x];
            to[x] = from[p.before] + p.share * (from[p.after] - from[p.before]);
        }
    }
}

/* ---- Light ---- */

static void decode(const front_frame_t *frame, const uint8_t *restrict bgr,
                   const float *restrict linear)
{
    const front_layout_t *layout = &frame->layout;
    const int image = layout->rows * layout->columns;
    for (int y = 0; y < layout->height[0]; y++) {
        float *restrict blue =
            frame->light + first_cell(layout, 0) + y * layout->columns;
        float *restrict green = blue + image;
        float *restrict red = green + image;
        for (int x = 0; x < layout->width[0]; x++, bgr += 3) {
            blue[x] = linear[bgr[0]];
            green[x] = linear[bgr[1]];
            red[x] = linear[bgr[2]];
        }
    }
}

/* Second difference along a row, which a slope does not have. */
static float bend(const float *row)
{
    return row[0] + row[2 * LAG] - 2.0F * row[LAG];
}

/* Covariance of the channels of single cells about the light nearby: from
 * second differences along rows without the large ones, which are edges. */
static void measure_fluctuation(const front_frame_t *frame)
{
    const front_layout_t *layout = &frame->layout;
    const int width = layout->width[0] - 2 * LAG;
    image_t light[3];
    for (int c = 0; c < 3; c++)
        light[c] = at_scale(layout, channel(layout, frame->light, c), 0);
    double total = 0;
    int cells = 0;
    for (int y = ROW_STEP / 2; y < light[0].rows; y += ROW_STEP) {
        float sum = 0;
        for (int c = 0; c < 3; c++) {
            const float *row = row_of(light[c], y);
            for (int x = 0; x < width; x++)
                sum += fabsf(bend(row + x));
        }
        total += (double)sum;
        cells += width;
    }
    const float limit = EDGE * (float)(total / cells);
    double product[3][3] = {{0}};
    int kept = 0;
    for (int y = ROW_STEP / 2; y < light[0].rows; y += ROW_STEP) {
        const float *b = row_of(light[0], y), *g = row_of(light[1], y),
                    *r = row_of(light[2], y);
        float bb = 0, gg = 0, rr = 0, bg = 0, br = 0, gr = 0, count = 0;
        for (int x = 0; x < width; x++) {
            float blue = bend(b + x), green = bend(g + x), red = bend(r + x);
            const float size = fabsf(blue) + fabsf(green) + fabsf(red);
            const float keep = size <= limit ? 1.0F : 0.0F;
            count += keep;
            bb += keep * blue * blue;
            gg += keep * green * green;
            rr += keep * red * red;
            bg += keep * blue * green;
            br += keep * blue * red;
            gr += keep * green * red;
        }
        const float sums[3][3] = {{bb, bg, br}, {bg, gg, gr}, {br, gr, rr}};
        for (int i = 0; i < 9; i++)
            product[i / 3][i % 3] += (double)sums[i / 3][i % 3];
        kept += (int)count;
    }
    /* A second difference of independent values has 1 + 1 + 4 times their
     * variance. */
    for (int i = 0; i < 9; i++)
        frame->covariance[i] = product[i / 3][i % 3] / (6.0 * most(kept, 1)) +
                               (i % 4 == 0 ? QUANTUM : 0.0);
}

/* Linear light of all scales. */
static bool make_light(const front_frame_t *frame, const uint8_t *bgr,
                       const float *linear)
{
    const front_layout_t *layout = &frame->layout;
    float *row = malloc((size_t)layout->columns * sizeof(float));
    if (row == NULL)
        return false;
    decode(frame, bgr, linear);
    for (int c = 0; c < 3; c++) {
        float *light = channel(layout, frame->light, c);
        for (int scale = 1; scale < layout->scales; scale++)
            shrink(at_scale(layout, light, scale - 1),
                   at_scale(layout, light, scale), row);
        for (int scale = 0; scale < layout->scales; scale++)
            repeat_outermost(layout, light, scale);
    }
    free(row);
    return true;
}

/* ---- Filters ---- */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double product[3])
{
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

/* The matched filter of colour s in noise of covariance S, S^-1 s / sqrt(s'
 * S^-1 s): the most signal of that colour for noise of 1 (North, Proc. IEEE 51
 * (1963) 1016); in colour space it takes the water's own hue out. */
static void match(const double *covariance, const double *s, float *weights)
{
    double product[3], whitened[3];
    for (int i = 0; i < 3; i++) {
        const double *next = covariance + (i + 1) % 3 * 3;
        cross(next, covariance + (i + 2) % 3 * 3, product);
        /* Times the determinant, which is positive. */
        whitened[i] = dot(product, s);
    }
    const double determinant = dot(product, covariance + 6);
    const double scale = 1 / sqrt(determinant * dot(s, whitened));
    for (int i = 0; i < 3; i++)
        weights[i] = (float)(scale * whitened[i]);
}

/* Two filters blind to colour s, whose noise is 1 and independent of each
 * other's: two vector products with s.  The noise of both, and of the matched
 * filter, is independent since f S f' = 0 for any two of them. */
static void look_across(const double *covariance, const double *s,
                        double *across)
{
    const int darkest =
        s[0] <= s[1] ? (s[0] <= s[2] ? 0 : 2) : (s[1] <= s[2] ? 1 : 2);
    const double axis[3] = {darkest == 0, darkest == 1, darkest == 2};
    double turned[3];
    cross(axis, s, across);
    for (int i = 0; i < 2; i++, across += 3) {
        for (int c = 0; c < 3; c++)
            turned[c] = dot(covariance + 3 * c, across);
        if (i == 0)
            cross(s, turned, across + 3);
        const double scale = 1 / sqrt(dot(turned, across));
        for (int c = 0; c < 3; c++)
            across[c] *= scale;
    }
}

/* ---- Response ---- */

/* One scale of a frame on the way to its response. */
typedef struct {
    image_t light[3], added[3];
    image_t snr;
    uint8_t *best;
    bool *clipped;   /* of each row, whether it may have a clipped cell */
    float *sums;     /* FRONT_HUES rows */
    float *answer;   /* one row */
    int *which;      /* one row */
    place_t *places; /* one row */
    float *coarse;   /* up to FRONT_HUES images of surrounds or of blocks */
    float *drawn;    /* the same as wide as the scale */
    float *spare;    /* one such image, with room for borders */
} work_t;

/* Images of parts some cells wide, one after the other in memory. */
static image_t parts_of(float *first, image_t whole, int wide, int which)
{
    const int rows = most(1, whole.rows / wide);
    const int columns = most(1, whole.columns / wide);
    return (image_t){first + which * rows * columns, columns, rows, columns};
}

/* The same as wide as the whole. */
static image_t drawn_out(float *first, image_t whole, int wide, int which)
{
    const int rows = most(1, whole.rows / wide);
    return (image_t){first + which * rows * whole.columns, whole.columns, rows,
                     whole.columns};
}

static void take_surround_away(work_t *work, int wide)
{
    const image_t whole = work->light[0];
    for (int c = 0; c < 3; c++) {
        const image_t coarse = parts_of(work->coarse, whole, wide, 0);
        const image_t drawn = drawn_out(work->drawn, whole, wide, 0);
        shrink(work->light[c], coarse, work->answer);
        draw_out(coarse, drawn, work->places);
        for (int y = 0; y < whole.rows; y++) {
            const place_t p = place_of(y, whole.rows, drawn.rows);
            const float *restrict above = row_of(drawn, p.before);
            const float *restrict below = row_of(drawn, p.after);
            const float *restrict light = row_of(work->light[c], y);
            float *restrict added = row_of(work->added[c], y);
            int high = 0;
            for (int x = 0; x < whole.columns; x++) {
                added[x] =
                    light[x] - (above[x] + p.share * (below[x] - above[x]));
                high |= light[x] >= (float)FRONT_CLIPPED_LIGHT;
            }
            work->clipped[y] |= high != 0;
        }
    }
}

/* Light through weights, of which the negative ones do not count if a channel
 * may have been clipped: that channel says only that there is as much or more,
 * and a lamp's core, which clips in more channels than its halo, would
 * otherwise be a hole in it. */
static float filtered(const float weights[3], const float added[3],
                      const float light[3])
{
    const float highest = greater(light[0], greater(light[1], light[2]));
    const bool clipped = highest >= (float)FRONT_CLIPPED_LIGHT;
    float sum = 0;
    for (int c = 0; c < 3; c++)
        sum += (clipped ? greater(weights[c], 0) : weights[c]) * added[c];
    return sum;
}

/* What a filter answers to a row, in work->answer. */
static void answer_row(const work_t *work, int y, const float weights[3])
{
    const float *restrict b = row_of(work->added[0], y);
    const float *restrict g = row_of(work->added[1], y);
    const float *restrict r = row_of(work->added[2], y);
    float *restrict answer = work->answer;
    const int columns = work->snr.columns;
    for (int x = 0; x < columns; x++)
        answer[x] = weights[0] * b[x] + weights[1] * g[x] + weights[2] * r[x];
    if (!work->clipped[y])
        return;
    for (int x = 0; x < columns; x++) {
        float light[3];
        for (int c = 0; c < 3; c++)
            light[c] = row_of(work->light[c], y)[x];
        answer[x] = filtered(weights, (float[3]){b[x], g[x], r[x]}, light);
    }
}

/* The k-th least of n values, from k = 0, which are put into another order
 * (Hoare's FIND). */
static float kth_least(float *values, int n, int k)
{
    int low = 0, high = n - 1;
    while (low < high) {
        const float pivot = values[k];
        int i = low, j = high;
        while (i <= j) {
            while (values[i] < pivot)
                i++;
            while (pivot < values[j])
                j--;
            if (i <= j) {
                const float value = values[i];
                values[i++] = values[j];
                values[j--] = value;
            }
        }
        if (j < k)
            low = i;
        if (k < i)
            high = j;
    }
    return values[k];
}

/* Index of a row or column that is as far inside n as i is outside. */
static int mirrored(int i, int n)
{
    while (n > 1 && (i < 0 || i >= n))
        i = i < 0 ? -i : 2 * (n - 1) - i;
    return n > 1 ? i : 0;
}

/* Gaussian smoothing, in place.  spare: room for the image and for a row with
 * REACH more at both ends. */
static void smooth(image_t image, float *spare)
{
    float kernel[2 * REACH + 1], sum = 0;
    for (int i = -REACH; i <= REACH; i++)
        sum += kernel[i + REACH] =
            (float)exp(-0.5 * i * i / (SMOOTHING * SMOOTHING));
    for (int i = 0; i <= 2 * REACH; i++)
        kernel[i] /= sum;
    const int columns = image.columns;
    const image_t across = {spare, columns, image.rows, columns};
    float *restrict wide = spare + image.rows * columns;
    memset(across.first, 0, (size_t)(image.rows * columns) * sizeof(float));
    for (int y = 0; y < image.rows; y++) {
        const float *from = row_of(image, y);
        float *restrict to = row_of(across, y);
        for (int x = -REACH; x < columns + REACH; x++)
            wide[x + REACH] = from[mirrored(x, columns)];
        for (int i = 0; i <= 2 * REACH; i++) {
            for (int x = 0; x < columns; x++)
                to[x] += kernel[i] * wide[x + i];
        }
    }
    for (int y = 0; y < image.rows; y++) {
        float *restrict to = row_of(image, y);
        memset(to, 0, (size_t)columns * sizeof(float));
        for (int i = -REACH; i <= REACH; i++) {
            const float *restrict from =
                row_of(across, mirrored(y + i, image.rows));
            for (int x = 0; x < columns; x++)
                to[x] += kernel[i + REACH] * from[x];
        }
    }
}

/* The local fluctuation of each filter's answers, in work->drawn. */
static void measure_noise(work_t *work, const float (*weights)[3])
{
    const image_t whole = work->snr;
    const int columns = whole.columns;
    const image_t blocks = parts_of(work->coarse, whole, BLOCK, 0);
    const float factor = mean_factor(whole.rows, columns, blocks);
    for (int k = 0; k < blocks.rows; k++) {
        const span_t span = span_of(k, whole.rows, blocks.rows);
        memset(work->sums, 0, (size_t)(FRONT_HUES * columns) * sizeof(float));
        for (int y = span.first; y <= span.last; y++) {
            const float share = share_of(&span, y);
            for (int hue = 0; hue < FRONT_HUES; hue++) {
                answer_row(work, y, weights[hue]);
                const float *restrict answer = work->answer;
                float *restrict sums = work->sums + hue * columns;
                for (int x = 0; x < columns; x++)
                    sums[x] += share * fabsf(answer[x]);
            }
        }
        for (int hue = 0; hue < FRONT_HUES; hue++) {
            const image_t noise = parts_of(work->coarse, whole, BLOCK, hue);
            sum_parts(work->sums + hue * columns, columns, row_of(noise, k),
                      noise.columns, factor);
        }
    }
    for (int hue = 0; hue < FRONT_HUES; hue++) {
        const image_t noise = parts_of(work->coarse, whole, BLOCK, hue);
        const int n = noise.rows * noise.columns;
        memcpy(work->spare, noise.first, (size_t)n * sizeof(float));
        const float median =
            greater(kth_least(work->spare, n, n / 2), NO_NOISE);
        for (int i = 0; i < n; i++) {
            const float value = greater(noise.first[i], LEAST_NOISE * median);
            noise.first[i] = NORMAL * lesser(value, MOST_NOISE * median);
        }
        smooth(noise, work->spare);
        draw_out(noise, drawn_out(work->drawn, whole, BLOCK, hue),
                 work->places);
    }
}

/* The largest answer over its noise, and whose it is. */
static void keep_largest(work_t *work, const float (*weights)[3])
{
    const image_t whole = work->snr;
    const int columns = whole.columns;
    int *restrict which = work->which;
    for (int y = 0; y < whole.rows; y++) {
        float *restrict snr = row_of(whole, y);
        for (int x = 0; x < columns; x++)
            snr[x] = -FLT_MAX;
        for (int hue = 0; hue < FRONT_HUES; hue++) {
            const image_t drawn = drawn_out(work->drawn, whole, BLOCK, hue);
            const place_t p = place_of(y, whole.rows, drawn.rows);
            const float *restrict above = row_of(drawn, p.before);
            const float *restrict below = row_of(drawn, p.after);
            answer_row(work, y, weights[hue]);
            const float *restrict answer = work->answer;
            const float less = hue == 0 ? 0.0F : (float)FRONT_UNEXPECTED;
            for (int x = 0; x < columns; x++) {
                const float noise = above[x] + p.share * (below[x] - above[x]);
                const float own = answer[x] / noise - less;
                const float other = snr[x];
                /* All bits, or none: a branch would keep the loop from being
                 * made of vector instructions. */
                const int larger = -(own > other);
                which[x] = (which[x] & ~larger) | (hue & larger);
                snr[x] = greater(own, other);
            }
        }
        uint8_t *restrict best = work->best + y * whole.stride;
        for (int x = 0; x < columns; x++)
            best[x] = (uint8_t)which[x];
    }
}

static bool respond_at_scale(front_frame_t *frame, int scale)
{
    const front_layout_t *layout = &frame->layout;
    const int wide =
        most(FRONT_SURROUND_PIXELS / layout->cell[scale], FRONT_SURROUND_CELLS);
    work_t work = {.snr = at_scale(layout, frame->snr, scale),
                   .best = frame->best + first_cell(layout, scale)};
    for (int c = 0; c < 3; c++) {
        float *light = channel(layout, frame->light, c);
        float *added = channel(layout, frame->added, c);
        work.light[c] = at_scale(layout, light, scale);
        work.added[c] = at_scale(layout, added, scale);
    }
    const int columns = work.snr.columns;
    const image_t parts = parts_of(NULL, work.snr, least(wide, BLOCK), 0);
    const int coarse = FRONT_HUES * parts.rows * parts.columns;
    const int drawn = FRONT_HUES * parts.rows * columns;
    const int spare = (parts.rows + 1) * parts.columns + 2 * REACH;
    const int numbers = (FRONT_HUES + 1) * columns + coarse + drawn + spare;
    float *floats = malloc((size_t)numbers * sizeof(float));
    int *which = malloc((size_t)columns * sizeof(int));
    place_t *places = malloc((size_t)columns * sizeof(place_t));
    bool *clipped = calloc((size_t)work.snr.rows, sizeof(bool));
    const bool enough = floats && which && places && clipped;
    if (enough) {
        work.sums = floats;
        work.answer = work.sums + FRONT_HUES * columns;
        work.coarse = work.answer + columns;
        work.drawn = work.coarse + coarse;
        work.spare = work.drawn + drawn;
        work.which = which;
        work.places = places;
        work.clipped = clipped;
        const float (*weights)[3] = (const float (*)[3])frame->weights;
        take_surround_away(&work, wide);
        measure_noise(&work, weights);
        keep_largest(&work, weights);
        repeat_outermost(layout, frame->snr, scale);
    }
    free(floats);
    free(which);
    free(places);
    free(clipped);
    return enough;
}

int front_respond(front_frame_t *frame, const uint8_t *bgr, const float *linear,
                  const double *signatures)
{
    if (!make_light(frame, bgr, linear))
        return -1;
    measure_fluctuation(frame);
    for (int hue = 0; hue < FRONT_HUES; hue++)
        match(frame->covariance, signatures + 3 * hue,
              frame->weights + 3 * hue);
    look_across(frame->covariance, signatures, frame->across);
    for (int scale = 0; scale < frame->layout.scales; scale++) {
        if (!respond_at_scale(frame, scale))
            return -1;
    }
    return 0;
}

/* ---- Peaks ---- */

/* A cell that stands out and is no lower than those about it. */
typedef struct {
    int at, scale, row, column;
    float strength; /* signal to noise of the brightest 2 x 2 cells with it */
    float centre;   /* its own signal to noise */
    float saddle;   /* see FRONT_SADDLE */
} summit_t;

/* Eight directions, those opposite four apart: to the right, then clockwise. */
static const int DOWN[8] = {0, 1, 1, 1, 0, -1, -1, -1};
static const int ACROSS[8] = {1, 1, 0, -1, -1, -1, 0, 1};

/* Values some cells off in the eight directions. */
static void look_around(const float *cell, int stride, int radius,
                        float around[8])
{
    for (int i = 0; i < 8; i++)
        around[i] = cell[radius * (DOWN[i] * stride + ACROSS[i])];
}

static float brightest(float centre, const float near[8])
{
    float highest = 0;
    for (int i = 0; i < 8; i += 2)
        highest = greater(highest, near[i] + near[i + 1] + near[(i + 2) % 8]);
    return 0.5F * (centre + highest);
}

/* Leaves the strongest, of equal ones the first, in the same order. */
static int keep_strongest(summit_t *summits, int n)
{
    if (n <= MAX_SUMMITS)
        return n;
    float strengths[2 * MAX_SUMMITS];
    for (int i = 0; i < n; i++)
        strengths[i] = summits[i].strength;
    const float limit = kth_least(strengths, n, n - MAX_SUMMITS);
    int equal = MAX_SUMMITS, kept = 0;
    for (int i = 0; i < n; i++)
        equal -= summits[i].strength > limit;
    for (int i = 0; i < n; i++) {
        const float strength = summits[i].strength;
        if (strength > limit || (strength >= limit && equal-- > 0))
            summits[kept++] = summits[i];
    }
    return kept;
}

/* Finds the strongest summits, row by row; room for twice MAX_SUMMITS. */
static int find_summits(const front_frame_t *frame, summit_t *summits)
{
    const front_layout_t *layout = &frame->layout;
    int n = 0;
    for (int scale = 0; scale < layout->scales; scale++) {
        const image_t snr = at_scale(layout, frame->snr, scale);
        const float least_snr =
            (float)(FRONT_MIN_SNR * layout->cell[scale] / layout->cell[0]);
        const float worth = (float)(CELL_SHARE * FRONT_MIN_SNR *
                                    layout->cell[scale] / layout->cell[0]);
        /* One in from the edge, so that a peak has neighbours on all sides. */
        for (int y = 1; y < snr.rows - 1; y++) {
            const float *row = row_of(snr, y);
            for (int x = 1; x < snr.columns - 1; x++) {
                const float centre = row[x];
                if (!(centre > worth))
                    continue;
                float near[8];
                look_around(row + x, snr.stride, 1, near);
                bool top = true;
                for (int i = 0; i < 8; i++)
                    top &= centre >= near[i];
                const float strength = brightest(centre, near);
                if (!top || strength < least_snr)
                    continue;
                if (n == 2 * MAX_SUMMITS)
                    n = keep_strongest(summits, n);
                summits[n++] = (summit_t){
                    .at = (int)(row + x - frame->snr),
                    .scale = scale,
                    .row = y,
                    .column = x,
                    .strength = strength,
                    .centre = centre,
                };
            }
        }
    }
    return keep_strongest(summits, n);
}

/* The least on the straight way between two cells. */
static float lowest_between(const front_frame_t *frame, const summit_t *from,
                            const summit_t *to)
{
    const int down = to->row - from->row, across = to->column - from->column;
    float lowest = FLT_MAX;
    for (int i = 1; i < PARTS; i++) {
        const int y = (int)lrint(from->row + (double)(down * i) / PARTS);
        const int x = (int)lrint(from->column + (double)(across * i) / PARTS);
        const int off =
            (y - from->row) * frame->layout.columns + x - from->column;
        lowest = lesser(lowest, frame->snr[from->at + off]);
    }
    return lowest;
}

/* Joins each of n summits, which are in order of rows, to higher ones nearby.
 */
static void find_saddles(const front_frame_t *frame, summit_t *summits, int n)
{
    for (int i = 0; i < n; i++) {
        summit_t *one = &summits[i];
        for (int j = i + 1; j < n; j++) {
            summit_t *other = &summits[j];
            const int down = other->row - one->row;
            const int across = other->column - one->column;
            if (other->scale != one->scale || down >= NEARBY)
                break;
            if (down * down + across * across >= NEARBY * NEARBY)
                continue;
            summit_t *low = one->centre < other->centre ? one : other;
            const summit_t *high = low == one ? other : one;
            if (high->centre > low->centre)
                low->saddle =
                    greater(low->saddle,
                            lowest_between(frame, low, high) / low->centre);
        }
    }
}

/* For qsort(): the strongest first, of equal ones the first of the frame. */
static int by_strength(const void *a, const void *b)
{
    const summit_t *one = a, *other = b;
    if (one->strength > other->strength)
        return -1;
    if (one->strength < other->strength)
        return 1;
    return one->at < other->at ? -1 : 1;
}

/* The second least and the second greatest of eight values. */
static void find_seconds(const float values[8], float *second_least,
                         float *second_greatest)
{
    float low = FLT_MAX, high = -FLT_MAX;
    *second_least = FLT_MAX;
    *second_greatest = -FLT_MAX;
    for (int i = 0; i < 8; i++) {
        const float value = values[i];
        *second_least = lesser(*second_least, greater(low, value));
        low = lesser(low, value);
        *second_greatest = greater(*second_greatest, lesser(high, value));
        high = greater(high, value);
    }
}

/* See FRONT_MISSING: against all but the darkest and the brightest of the
 * places about the cell, in units of the frame's fluctuation. */
static float missing_light(const front_frame_t *frame, int at)
{
    const front_layout_t *layout = &frame->layout;
    float missing = 0, adds = 0;
    for (int c = 0; c < 3; c++) {
        const float *cell = channel(layout, frame->light, c) + at;
        const float deviation = (float)sqrt(frame->covariance[4 * c]);
        float around[8], low, high;
        look_around(cell, layout->columns, FRONT_BORDER, around);
        find_seconds(around, &low, &high);
        missing = greater(missing, (low - *cell) / deviation);
        adds = greater(adds, (*cell - high) / deviation);
    }
    return missing / (adds + missing + 1.0F);
}

static void look_at(const front_frame_t *frame, const summit_t *summit,
                    double looks[FRONT_LOOKS])
{
    const float *cell = frame->snr + summit->at;
    const int stride = frame->layout.columns;
    float around[8], ridge = -FLT_MAX, halo = 0, unused, neighbour;
    for (int radius = 2; radius <= 3; radius++) {
        look_around(cell, stride, radius, around);
        for (int i = 0; i < 4; i++)
            ridge = greater(ridge, lesser(around[i], around[i + 4]));
    }
    for (int i = 0; i < 8; i++)
        halo += around[i] / 8.0F;
    find_seconds(around, &unused, &neighbour);
    looks[FRONT_RIDGE] = (double)(ridge / summit->centre);
    looks[FRONT_HALO] = (double)(halo / summit->centre);
    looks[FRONT_NEIGHBOUR] = (double)(neighbour / summit->centre);
    looks[FRONT_SADDLE] = (double)summit->saddle;
    looks[FRONT_MISSING] = (double)missing_light(frame, summit->at);
}

/* How far along an axis the top of a parabola is, in cells, half a one at most;
 * bend: twice the middle less both sides. */
static float top_of(float behind, float ahead, float bent)
{
    const float shift = (ahead - behind) / greater(2.0F * bent, 1e-6F);
    return lesser(greater(shift, -0.5F), 0.5F);
}

/* A paraboloid through 3 x 3 values: where its top is, and how flat. */
static void measure_top(const front_frame_t *frame, const summit_t *summit,
                        double xy[2], double *flatness)
{
    float near[8];
    look_around(frame->snr + summit->at, frame->layout.columns, 1, near);
    const float xx = 2.0F * summit->centre - near[0] - near[4];
    const float yy = 2.0F * summit->centre - near[2] - near[6];
    const float cross = (near[3] + near[7] - near[1] - near[5]) / 4.0F;
    const float trace = xx + yy;
    const float determinant = xx * yy - cross * cross;
    *flatness =
        (double)(1.0F - 4.0F * determinant / greater(trace * trace, 1e-12F));
    const int cell = frame->layout.cell[summit->scale];
    const float across = top_of(near[4], near[0], xx);
    const float down = top_of(near[6], near[2], yy);
    xy[0] = (summit->column + (double)across + 0.5) * cell - 0.5;
    xy[1] = (summit->row + (double)down + 0.5) * cell - 0.5;
}

void front_chroma(const front_frame_t *frame, const double *added, int n,
                  double *chroma)
{
    for (int i = 0; i < n; i++, added += 3, chroma += 2) {
        double off[2] = {0}, along = 0;
        for (int c = 0; c < 3; c++) {
            off[0] += frame->across[c] * added[c];
            off[1] += frame->across[3 + c] * added[c];
            along += (double)frame->weights[c] * added[c];
        }
        const double size = sqrt(off[0] * off[0] + off[1] * off[1]);
        const double scale = atan2(size, along) / fmax(size, 1e-9);
        chroma[0] = scale * off[0];
        chroma[1] = scale * off[1];
    }
}

void front_design(const double *looks, double snr, int scale, double *row)
{
    const double strength = log(fmin(snr, FRONT_MOST_SNR));
    const double base[FRONT_BASE] = {1.0, scale == 1 ? 1.0 : 0.0,
                                     scale >= 2 ? 1.0 : 0.0, strength,
                                     strength * strength};
    memcpy(row, base, sizeof(base));
    double *seen = row + FRONT_BASE;
    for (int i = 0; i < FRONT_LOOKS; i++) {
        seen[i] = fmin(fmax(looks[i], 0.0), 1.0);
        seen[FRONT_LOOKS + i] = sqrt(seen[i]);
    }
    for (int i = 0; i < 2 * FRONT_LOOKS; i++)
        seen[2 * FRONT_LOOKS + i] = seen[i] * strength;
}

/* Natural log of how much likelier such a peak is a lamp than clutter: two
 * logistic regressions give it, for the ratio of the posterior odds with the
 * looks to those without is the ratio of the densities of the looks. */
static double likeness_of(const double *looks, double snr, int scale,
                          const double *with_looks, const double *without)
{
    double row[FRONT_DESIGN], sum = 0;
    front_design(looks, snr, scale, row);
    for (int i = 0; i < FRONT_DESIGN; i++)
        sum += with_looks[i] * row[i];
    for (int i = 0; i < FRONT_BASE; i++)
        sum -= without[i] * row[i];
    return sum;
}

/* Chooses the peaks that are likelier lamps than clutter as strong is common,
 * of n peaks. */
static void choose_promising(const double *snr, const double *likeness, int n,
                             uint8_t *promising)
{
    double score[FRONT_MAX_PEAKS];
    for (int i = 0; i < n; i++)
        score[i] = likeness[i] < LEAST_LIKENESS
                       ? -DBL_MAX
                       : likeness[i] + WORTH * log(snr[i]);
    for (int i = 0; i < n; i++) {
        int better = 0;
        for (int j = 0; j < n; j++)
            better += score[j] > score[i] || (score[j] >= score[i] && j < i);
        promising[i] = score[i] > -DBL_MAX && better < FRONT_MAX_PROMISING;
    }
}

static void describe(const front_frame_t *frame, const summit_t *summit,
                     front_peaks_t *peaks, int k)
{
    const front_layout_t *layout = &frame->layout;
    const int best = frame->best[summit->at];
    float light[3], added[3];
    double exact[3];
    for (int c = 0; c < 3; c++) {
        light[c] = channel(layout, frame->light, c)[summit->at];
        added[c] = channel(layout, frame->added, c)[summit->at];
        exact[c] = (double)added[c];
    }
    const float excess = filtered(frame->weights + 3 * best, added, light);
    double *looks = peaks->looks + k * FRONT_LOOKS;
    look_at(frame, summit, looks);
    measure_top(frame, summit, peaks->xy + 2 * k, &looks[FRONT_FLATNESS]);
    front_chroma(frame, exact, 1, peaks->chroma + 2 * k);
    peaks->snr[k] = (double)summit->strength;
    peaks->noise[k] = (double)(greater(excess, 1e-6F) / summit->centre);
    peaks->best[k] = (uint8_t)best;
}

void front_find(const front_frame_t *frame, const double *with_looks,
                const double *without, front_peaks_t *peaks)
{
    summit_t summits[2 * MAX_SUMMITS];
    const int n = find_summits(frame, summits);
    find_saddles(frame, summits, n);
    qsort(summits, (size_t)n, sizeof(summit_t), by_strength);
    memset(peaks->count, 0, sizeof(peaks->count));
    for (int i = 0; i < n; i++) {
        const int scale = summits[i].scale;
        if (peaks->count[scale] == FRONT_MAX_PEAKS)
            continue;
        const int k = FRONT_MAX_PEAKS * scale + peaks->count[scale]++;
        describe(frame, &summits[i], peaks, k);
        peaks->likeness[k] =
            likeness_of(peaks->looks + k * FRONT_LOOKS, peaks->snr[k], scale,
                        with_looks, without);
    }
    for (int scale = 0; scale < frame->layout.scales; scale++) {
        const int first = FRONT_MAX_PEAKS * scale;
        choose_promising(peaks->snr + first, peaks->likeness + first,
                         peaks->count[scale], peaks->promising + first);
    }
}
