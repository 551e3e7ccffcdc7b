#include "internal/looks.h"
#include "internal/vectors.h"

#include <math.h>

#define TURN 6.283185307179586
/* Of eight places about what is dark so many are brighter: all but those along
 * two bars, as dark, that end there.  Beside something bright, whose light
 * makes its surround seem dark, only those towards it are, and between two
 * bright bars those towards these. */
#define BRIGHTER 6
/* By such a share of what it seems to lack, in the channel where that is most;
 * and it lacks so many standard deviations of a cell. */
#define LEAST_DARKER 0.5F
#define LEAST_LACK 2.0F

_Static_assert(FRONT_INPUTS == FRONT_LOOKS + FRONT_BASE - 1,
               "inputs are the looks, and the base without its 1");

void looks_prepare(int stride, ring_t rings[LOOKS_RINGS])
{
    for (int radius = 1; radius <= LOOKS_RINGS; radius++) {
        ring_t *ring = &rings[radius - 1];
        const int side = 2 * radius;
        ring->count = 4 * side;
        for (int i = 0; i < ring->count; i++) {
            /* From the upper left corner on, clockwise. */
            const int along = i % side - radius;
            const int down[4] = {-radius, along, radius, -along};
            const int across[4] = {along, radius, -along, -radius};
            ring->off[i] = down[i / side] * stride + across[i / side];
            const double angle = TURN * i / ring->count;
            const double waves[LOOKS_WAVES] = {1, cos(angle), sin(angle),
                                               cos(2 * angle), sin(2 * angle)};
            for (int k = 0; k < LOOKS_WAVES; k++)
                ring->waves[i][k] = (float)waves[k];
        }
    }
}

/* Size of a Fourier coefficient of so many values. */
static float coefficient(float cosine, float sine, int count)
{
    return sqrtf(cosine * cosine + sine * sine) / (float)count;
}

WIDE_VECTORS static void look_at_ring(const float *cell, const ring_t *ring,
                                      float centre, double looks[4])
{
    float values[LOOKS_LARGEST_RING], sums[LOOKS_WAVES] = {0}, square = 0;
    for (int i = 0; i < ring->count; i++)
        values[i] = cell[ring->off[i]] / centre;
    for (int i = 0; i < ring->count; i++) {
        square += values[i] * values[i];
        /* Unrolled, it would not be made of vector instructions. */
#pragma GCC unroll 1
        for (int k = 0; k < LOOKS_WAVES; k++)
            sums[k] += values[i] * ring->waves[i][k];
    }
    const float mean = sums[0] / (float)ring->count;
    const float variance = square / (float)ring->count - mean * mean;
    looks[0] = (double)mean;
    looks[1] = (double)sqrtf(greater(variance, 0));
    looks[2] = (double)coefficient(sums[1], sums[2], ring->count);
    looks[3] = (double)coefficient(sums[3], sums[4], ring->count);
}

/* The cell of another scale that a place is in. */
static const float *cell_at(const front_frame_t *frame, const float *snr,
                            int scale, const double xy[2])
{
    const front_layout_t *layout = &frame->layout;
    const int cell = layout->cell[scale];
    const int column = (int)((xy[0] + 0.5) / cell);
    const int row = (int)((xy[1] + 0.5) / cell);
    return snr + first_cell(layout, scale) +
           most(0, least(row, layout->height[scale] - 1)) * layout->columns +
           most(0, least(column, layout->width[scale] - 1));
}

/* The most of a cell and the eight about it, each times the sense. */
static float most_about(const float *cell, int stride, float sense)
{
    float near[8], highest = sense * *cell;
    look_around(cell, stride, 1, near);
    for (int i = 0; i < 8; i++)
        highest = greater(highest, sense * near[i]);
    return highest;
}

static void look_at_scales(const front_frame_t *frame, const summit_t *summit,
                           const double xy[2], double looks[FRONT_LOOKS])
{
    const int stride = frame->layout.columns, scale = summit->scale;
    looks[FRONT_COARSER] = looks[FRONT_COARSER_MOST] = looks[FRONT_COARSEST] =
        looks[FRONT_FINER_MOST] = -1.0;
    if (scale + 1 < frame->layout.scales) {
        const float *cell = cell_at(frame, frame->snr, scale + 1, xy);
        looks[FRONT_COARSER] = (double)(*cell / summit->centre);
        looks[FRONT_COARSER_MOST] =
            (double)(most_about(cell, stride, 1) / summit->centre);
    }
    if (scale + 2 < frame->layout.scales)
        looks[FRONT_COARSEST] =
            (double)(*cell_at(frame, frame->snr, scale + 2, xy) /
                     summit->centre);
    if (scale > 0) {
        /* The finest scale is kept in one sense alone. */
        const bool kept = frame->sense > 0 || scale > 1;
        const float *cell =
            cell_at(frame, kept ? frame->snr : frame->opposite, scale - 1, xy);
        looks[FRONT_FINER_MOST] =
            (double)(most_about(cell, stride, kept ? 1 : -1) / summit->centre);
    }
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

/* See FRONT_MISSING, against all but the darkest and the brightest of the
 * places about the cell, and FRONT_CHANNELS; in units of the frame's
 * fluctuation. */
static void look_at_channels(const front_frame_t *frame, int at,
                             double looks[FRONT_LOOKS])
{
    const front_layout_t *layout = &frame->layout;
    float missing = 0, adds = 0, added[3], rises[3];
    for (int c = 0; c < 3; c++) {
        const float *cell = channel(layout, frame->light, c) + at;
        const float deviation = (float)sqrt(frame->covariance[4 * c]);
        float around[8], low, high, sum = 0;
        look_around(cell, layout->columns, FRONT_BORDER, around);
        find_seconds(around, &low, &high);
        const float below = (low - *cell) / deviation;
        const float above = (*cell - high) / deviation;
        missing = greater(missing, frame->sense > 0 ? below : above);
        adds = greater(adds, frame->sense > 0 ? above : below);
        look_around(cell, layout->columns, 1, around);
        for (int i = 0; i < 8; i++)
            sum += around[i] / 8.0F;
        rises[c] = (float)frame->sense * (*cell - sum) / deviation;
        added[c] = fabsf(channel(layout, frame->added, c)[at]) / deviation;
    }
    looks[FRONT_MISSING] = (double)(missing / (adds + missing + 1.0F));
    const float strongest = greater(added[0], greater(added[1], added[2]));
    for (int place = 0; place < 3; place++) {
        int next = 0;
        for (int c = 1; c < 3; c++)
            if (added[c] > added[next])
                next = c;
        looks[FRONT_CHANNELS + place] =
            (double)(rises[next] / greater(strongest, 1e-6F));
        added[next] = -1.0F;
    }
}

bool looks_dark(const front_frame_t *frame, int at)
{
    const front_layout_t *layout = &frame->layout;
    int darkest = 0;
    float lacks = 0, least = 0;
    for (int c = 0; c < 3; c++) {
        const float lack = -channel(layout, frame->added, c)[at];
        const float deviation = (float)sqrt(frame->covariance[4 * c]);
        if (lack / deviation > lacks) {
            darkest = c;
            lacks = lack / deviation;
            least = LEAST_DARKER * lack;
        }
    }
    const float *cell = channel(layout, frame->light, darkest) + at;
    float around[8];
    look_around(cell, layout->columns, FRONT_BORDER, around);
    int brighter = 0;
    for (int i = 0; i < 8; i++)
        brighter += around[i] > *cell + least;
    return lacks >= LEAST_LACK && brighter >= BRIGHTER;
}

void looks_at(const front_frame_t *frame, const ring_t rings[LOOKS_RINGS],
              const summit_t *summit, const double xy[2], double flatness,
              double looks[FRONT_LOOKS])
{
    looks[FRONT_FLATNESS] = flatness;
    looks[FRONT_SADDLE] = (double)summit->saddle;
    for (int i = 0; i < LOOKS_RINGS; i++)
        look_at_ring(frame->snr + summit->at, &rings[i], summit->centre,
                     looks + FRONT_RINGS + 4 * i);
    look_at_scales(frame, summit, xy, looks);
    look_at_channels(frame, summit->at, looks);
}

void front_inputs(const double *looks, double snr, int scale, float *inputs)
{
    for (int i = 0; i < FRONT_LOOKS; i++) {
        const float low = i < FRONT_RINGS      ? 0.0F
                          : i < FRONT_CHANNELS ? -1.0F
                                               : -2.0F;
        const float high = i < FRONT_RINGS ? 1.0F : 2.0F;
        inputs[i] = lesser(greater((float)looks[i], low), high);
    }
    const float strength = (float)log(fmin(snr, FRONT_MOST_SNR));
    float *base = inputs + FRONT_LOOKS;
    base[0] = strength;
    base[1] = strength * strength;
    base[2] = scale == 0 ? 1.0F : 0.0F;
    base[3] = scale == 2 ? 1.0F : 0.0F;
    base[4] = scale >= 3 ? 1.0F : 0.0F;
}

WIDE_VECTORS double looks_likeness(const front_network_t *network,
                                   const double *looks, double snr, int scale)
{
    float inputs[FRONT_INPUTS + 1], hidden[FRONT_HIDDEN] = {0}, sum = 0;
    front_inputs(looks, snr, scale, inputs);
    inputs[FRONT_INPUTS] = 1.0F;
    for (int i = 0; i <= FRONT_INPUTS; i++) {
        /* Unrolled, it would not be made of vector instructions. */
#pragma GCC unroll 1
        for (int j = 0; j < FRONT_HIDDEN; j++)
            hidden[j] += inputs[i] * network->hidden[i][j];
        sum += inputs[i] * network->of_inputs[i];
    }
    for (int j = 0; j < FRONT_HIDDEN; j++)
        sum += network->of_hidden[j] * hidden[j] / (1.0F + fabsf(hidden[j]));
    for (int i = 0; i < FRONT_BASE; i++)
        sum -= network->without[i] * inputs[FRONT_LOOKS + i];
    const double ratio = exp((double)sum), known = 1 - FRONT_STRANGE;
    return log((known * ratio + FRONT_STRANGE) /
               (known + FRONT_STRANGE * ratio));
}
