#include "internal/summits.h"

#include "internal/vectors.h"

#include <math.h>
#include <string.h>

/* A lamp between four cells has half its signal to noise in each; noise would
 * seldom add more. */
#define CELL_SHARE 0.7
/* Cells that are compared together, and so many bytes that are looked at
 * together: in few of them does any cell stand out. */
#define BATCH 64
#define AT_ONCE 8
/* Cells within which a peak may belong to a higher one, and into how many parts
 * the way there is cut. */
#define NEARBY 12
#define PARTS 8

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
        /* The first byte is the lowest on every processor that this is built
         * for. */
        for (; any != 0; any &= any - 1)
            above[count++] = first + __builtin_ctzll(any) / 8;
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
    const double weakest =
        frame->sense > 0 ? FRONT_MIN_SNR : FRONT_MIN_DARK_SNR;
    const float least_snr = (float)weakest * wider;
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

int summits_find(const front_frame_t *frame, summit_t summits[2 * MAX_SUMMITS])
{
    /* What is dark in the finest cells is JPEG's doing about a lamp rather than
     * a holder; and they are seen through one filter alone. */
    int n = 0;
    for (int scale = frame->sense > 0 ? 0 : 1; scale < frame->layout.scales;
         scale++)
        n = add_summits(frame, scale, summits, n);
    n = keep_strongest(summits, n);
    find_saddles(frame, summits, n);
    return n;
}
