#include "internal/cells.h"
#include "internal/vectors.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A lamp between four cells has half its signal to noise in each; noise would
 * seldom add more. */
#define CELL_SHARE 0.7
/* Cells that are compared together, and so many bytes that are looked at
 * together: in few of them does any cell stand out. */
#define BATCH 64
#define AT_ONCE 8
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
    const float limit = cells_kth_least(strengths, n, n - MAX_SUMMITS);
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

/* Lists which of n cells, BATCH at most, are above a limit; returns how many.
 */
static inline int list_above(const float *restrict cells, int n, float limit,
                             int above[BATCH])
{
    uint8_t is_above[BATCH] = {0};
    for (int x = 0; x < n; x++)
        is_above[x] = cells[x] > limit;
    int count = 0;
    for (int first = 0; first < BATCH; first += AT_ONCE) {
        uint64_t any;
        memcpy(&any, is_above + first, sizeof(any));
        if (any == 0)
            continue;
        for (int x = first; x < first + AT_ONCE; x++) {
            above[count] = x;
            count += is_above[x];
        }
    }
    return count;
}

/* Whether a cell is a summit, and how strong. */
static inline bool is_summit(const float *cell, int stride, float least_snr,
                             float *strength)
{
    const float centre = *cell;
    float near[8];
    look_around(cell, stride, 1, near);
    /* Of equal cells the first is the top: the others come after. */
    bool top = true;
    for (int i = 0; i < 4; i++)
        top &= centre >= near[i] && centre > near[i + 4];
    *strength = brightest(centre, near);
    return top && *strength >= least_snr;
}

/* Adds those of a scale, row by row, to n summits; returns how many there are,
 * the strongest of all where they have no room. */
WIDE_VECTORS static int add_summits(const front_frame_t *frame, int scale,
                                    summit_t summits[2 * MAX_SUMMITS], int n)
{
    const front_layout_t *layout = &frame->layout;
    const image_t snr = at_scale(layout, frame->snr, scale);
    const float wider =
        greater((float)layout->cell[scale] / (float)layout->cell[1], 1.0F);
    const float least_snr = (float)FRONT_MIN_SNR * wider;
    const float worth = (float)CELL_SHARE * least_snr;
    /* One in from the edge, so that a peak has neighbours on all sides. */
    const int end = snr.columns - 1;
    for (int y = 1; y < snr.rows - 1; y++) {
        for (int first = 1; first < end; first += BATCH) {
            const float *cells = row_of(snr, y) + first;
            int above[BATCH];
            const int count =
                list_above(cells, least(end - first, BATCH), worth, above);
            for (int i = 0; i < count; i++) {
                const float *cell = cells + above[i];
                float strength;
                if (!is_summit(cell, snr.stride, least_snr, &strength))
                    continue;
                if (n == 2 * MAX_SUMMITS)
                    n = keep_strongest(summits, n);
                summits[n++] = (summit_t){
                    .at = (int)(cell - frame->snr),
                    .scale = scale,
                    .row = y,
                    .column = first + above[i],
                    .strength = strength,
                    .centre = *cell,
                };
            }
        }
    }
    return n;
}

/* Finds the strongest summits, scale by scale, row by row. */
static int find_summits(const front_frame_t *frame,
                        summit_t summits[2 * MAX_SUMMITS])
{
    int n = 0;
    for (int scale = 0; scale < frame->layout.scales; scale++)
        n = add_summits(frame, scale, summits, n);
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
            along += frame->axes[c] * added[c];
            off[0] += frame->axes[3 + c] * added[c];
            off[1] += frame->axes[6 + c] * added[c];
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
    const double base[FRONT_BASE] = {1.0,
                                     scale == 0 ? 1.0 : 0.0,
                                     scale == 2 ? 1.0 : 0.0,
                                     scale >= 3 ? 1.0 : 0.0,
                                     strength,
                                     strength * strength};
    memcpy(row, base, sizeof(base));
    double *seen = row + FRONT_BASE;
    for (int i = 0; i < FRONT_LOOKS; i++) {
        seen[i] = fmin(fmax(looks[i], 0.0), 1.0);
        seen[FRONT_LOOKS + i] = sqrt(seen[i]);
    }
    /* At the finest scale the same number of cells is half as far, and a lamp
     * has more about it. */
    for (int i = 0; i < 2 * FRONT_LOOKS; i++) {
        seen[2 * FRONT_LOOKS + i] = seen[i] * strength;
        seen[4 * FRONT_LOOKS + i] = scale == 0 ? seen[i] : 0.0;
    }
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
            better += score[j] > score[i] || (j < i && score[j] >= score[i]);
        promising[i] = score[i] > -DBL_MAX && better < FRONT_MAX_PROMISING;
    }
}

/* Of the span of a radius to both sides of a place, how much is in 0..size. */
static double share_inside(double place, double radius, double size)
{
    const double seen = fmin(place + radius, size) - fmax(place - radius, 0.0);
    return fmax(seen, 0.0) / (2 * radius);
}

static double inside_of(const front_layout_t *layout, const double xy[2])
{
    const double width = layout->width[0] * layout->cell[0];
    const double height = layout->height[0] * layout->cell[0];
    const double radius = FRONT_NEIGHBOURHOOD * sqrt(width * height);
    return share_inside(xy[0], radius, width) *
           share_inside(xy[1], radius, height);
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
    const float excess = filtered(frame->weights + 3 * best,
                                  least_weight(light[0], light[1], light[2]),
                                  added[0], added[1], added[2]);
    double *looks = peaks->looks + k * FRONT_LOOKS;
    look_at(frame, summit, looks);
    measure_top(frame, summit, peaks->xy + 2 * k, &looks[FRONT_FLATNESS]);
    peaks->inside[k] = inside_of(layout, peaks->xy + 2 * k);
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
