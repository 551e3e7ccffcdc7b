#include "internal/cells.h"
#include "internal/vectors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The local noise is the mean of blocks of so many cells squared, ... */
#define BLOCK 8
/* ... at least and at most so many times the frame's median: no less than that
 * of almost all the frame, no more than what markers themselves may raise it
 * to. */
#define LEAST_NOISE 0.9F
#define MOST_NOISE 2.5F
/* Filtered light: no frame has less noise than this. */
#define NO_NOISE 1e-3F
/* Standard deviation over mean absolute value of a normal variable. */
#define NORMAL 1.2533141F

/* One scale of a frame on the way to its response. */
typedef struct {
    image_t light[3], added[3];
    /* The light of the next scale, or of the last scale its own: the surround
     * is smooth, and its mean costs a quarter there. */
    image_t coarser[3];
    image_t snr, dark_snr;
    uint8_t *best;
    bool *clipped; /* of each row, whether it may have a clipped cell */
    int hues;      /* filters that are looked through */
    float *sums;   /* as many rows */
    float *shares; /* one row, also room for a sum of rows */
    int *which;    /* one row */
    float *least;  /* one row: the least weights that count */
    float *coarse; /* up to FRONT_HUES images of surrounds or of blocks */
    float *drawn;  /* the same as wide as the scale */
    float *spare;  /* room for smoothing one of the former */
} work_t;

/* How many parts, about so many cells wide, n cells are divided into. */
static int parts(int n, int wide)
{
    return most(1, n / wide);
}

/* Images of such parts, one after the other in memory. */
static image_t parts_of(float *first, image_t whole, int wide, int which)
{
    const int rows = parts(whole.rows, wide);
    const int columns = parts(whole.columns, wide);
    return (image_t){first + which * rows * columns, columns, rows, columns};
}

/* The same drawn out to the columns of the whole. */
static image_t drawn_out(float *first, image_t whole, int wide, int which)
{
    const int rows = parts(whole.rows, wide);
    return (image_t){first + which * rows * whole.columns, whole.columns, rows,
                     whole.columns};
}

/* Draws some images of parts, in work->coarse, out into work->drawn. */
static void draw_all_out(work_t *work, int wide, int images)
{
    image_t coarse = parts_of(work->coarse, work->snr, wide, 0);
    image_t drawn = drawn_out(work->drawn, work->snr, wide, 0);
    coarse.rows *= images;
    drawn.rows *= images;
    cells_draw_out(coarse, drawn, work->shares);
}

/* The light that a row adds, and the least weights that count in its cells. */
typedef struct {
    const float *blue, *green, *red;
    const float *least;
} row_t;

static inline row_t added_row(const work_t *work, int y)
{
    if (work->clipped[y]) {
        const float *restrict blue = row_of(work->light[0], y);
        const float *restrict green = row_of(work->light[1], y);
        const float *restrict red = row_of(work->light[2], y);
        float *restrict least = work->least;
        for (int x = 0; x < work->snr.columns; x++)
            least[x] = least_weight(blue[x], green[x], red[x]);
    }
    return (row_t){row_of(work->added[0], y), row_of(work->added[1], y),
                   row_of(work->added[2], y), work->least};
}

/* What a filter answers to a cell of a row.  any_clipped: whether the row may
 * have a clipped cell. */
static inline float answer_at(const row_t *row, int x, bool any_clipped,
                              const float weights[3])
{
    return filtered(weights, any_clipped ? row->least[x] : -FLT_MAX,
                    row->blue[x], row->green[x], row->red[x]);
}

/* The light that each cell of a row adds to that of the water about it, which
 * is between those of two rows of surrounds. */
static inline void add_row(work_t *work, int wide, int y)
{
    const int columns = work->snr.columns;
    const place_t p =
        cells_place(y, work->snr.rows, parts(work->snr.rows, wide));
    int high = 0;
    for (int c = 0; c < 3; c++) {
        const image_t drawn = drawn_out(work->drawn, work->snr, wide, c);
        const float *restrict above = row_of(drawn, p.before);
        const float *restrict below = row_of(drawn, p.after);
        const float *restrict light = row_of(work->light[c], y);
        float *restrict added = row_of(work->added[c], y);
        for (int x = 0; x < columns; x++) {
            added[x] = light[x] - (above[x] + p.share * (below[x] - above[x]));
            high |= light[x] >= (float)FRONT_CLIPPED_LIGHT;
        }
    }
    work->clipped[y] = high != 0;
}

/* What one filter answers to a row, in the row of its signal to noise. */
static inline void answer_row(work_t *work, int y, const float weights[3])
{
    const row_t row = added_row(work, y);
    float *restrict answers = row_of(work->snr, y);
    if (work->clipped[y]) {
        for (int x = 0; x < work->snr.columns; x++)
            answers[x] = answer_at(&row, x, true, weights);
    } else {
        for (int x = 0; x < work->snr.columns; x++)
            answers[x] = answer_at(&row, x, false, weights);
    }
}

/* The light that all cells add, and what the filter answers if it is one. */
WIDE_VECTORS static void take_surround_away(work_t *work, int wide,
                                            const float (*weights)[3])
{
    for (int c = 0; c < 3; c++)
        cells_shrink(work->coarser[c],
                     parts_of(work->coarse, work->snr, wide, c), work->shares);
    draw_all_out(work, wide, 3);
    for (int y = 0; y < work->snr.rows; y++) {
        add_row(work, wide, y);
        if (work->hues == 1)
            answer_row(work, y, weights[0]);
    }
}

/* Adds a share of the sizes of a row of answers to sums. */
static inline void add_sizes_of(const float *restrict answers, int columns,
                                float share, float *restrict sums)
{
    for (int x = 0; x < columns; x++)
        sums[x] += share * fabsf(answers[x]);
}

/* Adds a share of the size of what a filter answers to a row to sums. */
static inline void add_sizes(const row_t *row, int columns, bool any_clipped,
                             const float weights[3], float share,
                             float *restrict sums)
{
    for (int x = 0; x < columns; x++)
        sums[x] += share * fabsf(answer_at(row, x, any_clipped, weights));
}

/* The local fluctuation of each filter's answers, in work->drawn. */
WIDE_VECTORS static void measure_noise(work_t *work, const float (*weights)[3])
{
    const image_t whole = work->snr;
    const int columns = whole.columns;
    const image_t blocks = parts_of(work->coarse, whole, BLOCK, 0);
    const float factor = cells_mean_factor(whole.rows, columns, blocks);
    for (int k = 0; k < blocks.rows; k++) {
        const span_t span = cells_span(k, whole.rows, blocks.rows);
        memset(work->sums, 0, (size_t)(work->hues * columns) * sizeof(float));
        for (int y = span.first; y <= span.last; y++) {
            const float share = cells_share(&span, y);
            if (work->hues == 1) {
                add_sizes_of(row_of(whole, y), columns, share, work->sums);
                continue;
            }
            const row_t row = added_row(work, y);
            for (int hue = 0; hue < work->hues; hue++) {
                float *sums = work->sums + hue * columns;
                /* Two loops, neither of which has to ask. */
                if (work->clipped[y])
                    add_sizes(&row, columns, true, weights[hue], share, sums);
                else
                    add_sizes(&row, columns, false, weights[hue], share, sums);
            }
        }
        for (int hue = 0; hue < work->hues; hue++) {
            const image_t noise = parts_of(work->coarse, whole, BLOCK, hue);
            cells_sum_parts(work->sums + hue * columns, columns,
                            row_of(noise, k), noise.columns, factor);
        }
    }
    for (int hue = 0; hue < work->hues; hue++) {
        const image_t noise = parts_of(work->coarse, whole, BLOCK, hue);
        const int n = noise.rows * noise.columns;
        memcpy(work->spare, noise.first, (size_t)n * sizeof(float));
        const float median =
            greater(cells_kth_least(work->spare, n, n / 2), NO_NOISE);
        for (int i = 0; i < n; i++) {
            const float value = greater(noise.first[i], LEAST_NOISE * median);
            noise.first[i] = NORMAL * lesser(value, MOST_NOISE * median);
        }
        cells_smooth(noise, work->spare);
    }
    draw_all_out(work, BLOCK, work->hues);
}

/* The local noise of a row, between that of the rows of blocks above and below
 * it.  Those of the filters are so many numbers apart. */
typedef struct {
    const float *above, *below;
    int apart;
    float share;
} noise_t;

/* The answers of one filter to a row over their noise. */
static inline void over_noise(float *restrict answers, int columns,
                              const noise_t *noise)
{
    for (int x = 0; x < columns; x++)
        answers[x] /= noise->above[x] +
                      noise->share * (noise->below[x] - noise->above[x]);
}

/* The largest of the filters' answers to a row over their noise, and whose it
 * is; and the largest of what they are less than nothing. */
static inline void keep_row(const row_t *row, int columns, bool any_clipped,
                            const float (*weights)[3], const noise_t *noise,
                            float unexpected, float *restrict snr,
                            int *restrict which, float *restrict dark_snr)
{
    for (int x = 0; x < columns; x++) {
        float largest = 0, darkest = 0;
        int whose = 0;
#pragma GCC unroll 6
        for (int hue = 0; hue < FRONT_HUES; hue++) {
            const float above = noise->above[hue * noise->apart + x];
            const float below = noise->below[hue * noise->apart + x];
            const float own = answer_at(row, x, any_clipped, weights[hue]) /
                              (above + noise->share * (below - above));
            const float counted = hue == 0 ? own : own - unexpected;
            /* All bits, or none: a branch would keep the loop from being made
             * of vector instructions. */
            const int larger = -(hue == 0 || counted > largest);
            whose = (whose & ~larger) | (hue & larger);
            largest = hue == 0 ? counted : greater(counted, largest);
            darkest = greater(-own, darkest);
        }
        snr[x] = largest;
        which[x] = whose;
        dark_snr[x] = darkest;
    }
}

/* The largest answer over its noise, and whose it is, of all cells. */
WIDE_VECTORS static void keep_largest(work_t *work, const float (*weights)[3],
                                      float unexpected)
{
    const image_t whole = work->snr;
    const int columns = whole.columns;
    const image_t drawn = drawn_out(work->drawn, whole, BLOCK, 0);
    for (int y = 0; y < whole.rows; y++) {
        const place_t p = cells_place(y, whole.rows, drawn.rows);
        const noise_t noise = {row_of(drawn, p.before), row_of(drawn, p.after),
                               drawn.rows * columns, p.share};
        float *snr = row_of(whole, y), *dark = row_of(work->dark_snr, y);
        uint8_t *restrict best = work->best + y * whole.stride;
        if (work->hues == 1) {
            over_noise(snr, columns, &noise);
            memset(best, 0, (size_t)columns);
            continue;
        }
        const row_t row = added_row(work, y);
        if (work->clipped[y])
            keep_row(&row, columns, true, weights, &noise, unexpected, snr,
                     work->which, dark);
        else
            keep_row(&row, columns, false, weights, &noise, unexpected, snr,
                     work->which, dark);
        const int *restrict which = work->which;
        for (int x = 0; x < columns; x++)
            best[x] = (uint8_t)which[x];
    }
}

/* Fills in one scale of added, snr and best; false if there is no memory. */
static bool respond_at_scale(front_frame_t *frame, int scale, float unexpected)
{
    const front_layout_t *layout = &frame->layout;
    const int wide =
        most(FRONT_SURROUND_PIXELS / layout->cell[scale], FRONT_SURROUND_CELLS);
    work_t work = {.snr = at_scale(layout, frame->snr, scale),
                   .dark_snr = at_scale(layout, frame->opposite, scale),
                   .best = frame->best + first_cell(layout, scale),
                   .hues = scale == 0 ? 1 : FRONT_HUES};
    for (int c = 0; c < 3; c++) {
        float *light = channel(layout, frame->light, c);
        float *added = channel(layout, frame->added, c);
        work.light[c] = at_scale(layout, light, scale);
        work.coarser[c] =
            at_scale(layout, light, least(scale + 1, layout->scales - 1));
        work.added[c] = at_scale(layout, added, scale);
    }
    const int columns = work.snr.columns;
    /* Surrounds may be smaller than blocks, but there are fewer images of them.
     */
    const int finest = least(wide, BLOCK);
    const int parts_down = parts(work.snr.rows, finest);
    const int parts_across = parts(columns, finest);
    const int coarse = FRONT_HUES * parts_down * parts_across;
    const int drawn = FRONT_HUES * parts_down * columns;
    const int spare = cells_smooth_room(parts_down, parts_across);
    const int numbers = (FRONT_HUES + 2) * columns + coarse + drawn + spare;
    float *floats = malloc((size_t)numbers * sizeof(float));
    int *which = malloc((size_t)columns * sizeof(int));
    bool *clipped = calloc((size_t)work.snr.rows, sizeof(bool));
    const bool enough = floats && which && clipped;
    if (enough) {
        work.sums = floats;
        work.shares = work.sums + FRONT_HUES * columns;
        work.least = work.shares + columns;
        work.coarse = work.least + columns;
        work.drawn = work.coarse + coarse;
        work.spare = work.drawn + drawn;
        work.which = which;
        work.clipped = clipped;
        const float (*weights)[3] = (const float (*)[3])frame->weights;
        take_surround_away(&work, wide, weights);
        measure_noise(&work, weights);
        keep_largest(&work, weights, unexpected);
        cells_repeat_outermost(layout, frame->snr, scale);
        if (work.hues > 1)
            cells_repeat_outermost(layout, frame->opposite, scale);
    }
    free(floats);
    free(which);
    free(clipped);
    return enough;
}

int front_respond(front_frame_t *frame, const uint8_t *bgr, int pixels,
                  const float *linear, const double *signatures,
                  float unexpected)
{
    if (!light_make(frame, bgr, pixels, linear))
        return -1;
    filters_make(frame, signatures);
    for (int scale = 0; scale < frame->layout.scales; scale++) {
        if (!respond_at_scale(frame, scale, unexpected))
            return -1;
    }
    return 0;
}

WIDE_VECTORS int front_standing_out(const front_frame_t *frame, int scale,
                                    uint8_t *cells)
{
    const image_t snr = at_scale(&frame->layout, frame->snr, scale);
    int count = 0;
    for (int y = 0; y < snr.rows; y++) {
        const float *row = row_of(snr, y);
        for (int x = 0; x < snr.columns; x++) {
            cells[x] = row[x] >= (float)FRONT_MIN_SNR;
            count += cells[x];
        }
        cells += snr.columns;
    }
    return count;
}
