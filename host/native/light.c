#include "internal/cells.h"
#include "internal/pixels.h"
#include "internal/vectors.h"

#include <math.h>
#include <stdlib.h>

/* The scale on whose cells the fluctuation is measured: about as wide as what
 * the lens makes of a far lamp. */
#define MEASURED 1
/* Neighbours at this lag, in cells of that scale, share neither a marker nor
 * JPEG's blocks of 8 pixels. */
#define LAG 2
/* The fluctuation is measured on one row in so many: 2,300 cells fix six
 * numbers to 3%. */
#define ROW_STEP 8
/* Differences beyond so many times their mean are edges and lamps.  What
 * fluctuates more than noise, foam, caustics and glitter, counts: the filter
 * had better be blind to its colour as well.  Of 1,600 drawn scenes of the half
 * that was developed on 1,187 docks are found with a limit of 2.5, 1,196 with
 * 5, 1,199 with 8, and 1,188 with none. */
#define EDGE 8.0F

/* Mean of two bytes, rounded, halves up: one vector instruction. */
static inline uint8_t mean_up(uint8_t one, uint8_t other)
{
    return (uint8_t)((one + other + 1) >> 1);
}

/* Means of 2 x 2 pixels of two rows of n numbers, 3 a pixel, rounded, halves
 * up: at every sixth number begins the mean that two pixels have. */
static inline void halve_rows(const uint8_t *restrict above,
                              const uint8_t *restrict below, int n,
                              uint8_t *restrict means)
{
    for (int k = 0; k < n - 3; k++) {
        const uint8_t a = above[k], b = above[k + 3];
        const uint8_t c = below[k], d = below[k + 3];
        const uint8_t upper = mean_up(a, b), lower = mean_up(c, d);
        /* Where the mean of both is rounded up, and one of them was before, it
         * is one too much. */
        const uint8_t over =
            (uint8_t)(((a ^ b) | (c ^ d)) & (upper ^ lower) & 1);
        means[k] = (uint8_t)(mean_up(upper, lower) - over);
    }
}

/* Linear light of four cells of a row, which are stored at once. */
static inline void decode_four(const uint8_t *restrict codes, int apart,
                               const float *restrict linear,
                               float *restrict light)
{
    light[0] = linear[codes[0]];
    light[1] = linear[codes[apart]];
    light[2] = linear[codes[2 * apart]];
    light[3] = linear[codes[3 * apart]];
}

/* Linear light of a row of cells, each so many bytes after the one before. */
static inline void decode_row(const uint8_t *restrict bgr, int apart,
                              const float *restrict linear, int cells,
                              float *restrict blue, float *restrict green,
                              float *restrict red)
{
    int x = 0;
    for (; x + 4 <= cells; x += 4, bgr += 4 * apart) {
        decode_four(bgr, apart, linear, blue + x);
        decode_four(bgr + 1, apart, linear, green + x);
        decode_four(bgr + 2, apart, linear, red + x);
    }
    for (; x < cells; x++, bgr += apart) {
        blue[x] = linear[bgr[0]];
        green[x] = linear[bgr[1]];
        red[x] = linear[bgr[2]];
    }
}

/* Linear light of the finest cells.  room: for one row of the picture. */
WIDE_VECTORS static void decode(const front_frame_t *frame, const uint8_t *bgr,
                                int pixels, const float *linear, uint8_t *room)
{
    const front_layout_t *layout = &frame->layout;
    const int image = layout->rows * layout->columns;
    const int columns = layout->width[0], numbers = 3 * columns * pixels;
    for (int y = 0; y < layout->height[0]; y++, bgr += numbers * pixels) {
        float *blue =
            frame->light + first_cell(layout, 0) + y * layout->columns;
        float *green = blue + image, *red = green + image;
        if (pixels == 1) {
            decode_row(bgr, 3, linear, columns, blue, green, red);
        } else {
            halve_rows(bgr, bgr + numbers, numbers, room);
            decode_row(room, 6, linear, columns, blue, green, red);
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
    const int width = layout->width[MEASURED] - 2 * LAG;
    image_t light[3];
    for (int c = 0; c < 3; c++)
        light[c] = at_scale(layout, channel(layout, frame->light, c), MEASURED);
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

bool light_make(const front_frame_t *frame, const uint8_t *bgr, int pixels,
                const float *linear)
{
    const front_layout_t *layout = &frame->layout;
    float *row = malloc((size_t)layout->columns * sizeof(float));
    uint8_t *bytes = malloc(6 * (size_t)layout->columns);
    const bool enough = row && bytes;
    if (enough) {
        decode(frame, bgr, pixels, linear, bytes);
        for (int c = 0; c < 3; c++) {
            float *light = channel(layout, frame->light, c);
            for (int scale = 1; scale < layout->scales; scale++)
                cells_shrink(at_scale(layout, light, scale - 1),
                             at_scale(layout, light, scale), row);
            for (int scale = 0; scale < layout->scales; scale++)
                cells_repeat_outermost(layout, light, scale);
        }
        measure_fluctuation(frame);
    }
    free(row);
    free(bytes);
    return enough;
}

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

void filters_make(const front_frame_t *frame, const double *signatures)
{
    for (int hue = 0; hue < FRONT_HUES; hue++)
        match(frame->covariance, signatures + 3 * hue,
              frame->weights + 3 * hue);
    /* About white, no lamp's chroma comes near the pole opposite, where two
     * like colours would have unlike angles. */
    const double white[3] = {1, 1, 1};
    float along[3];
    match(frame->covariance, white, along);
    for (int c = 0; c < 3; c++)
        frame->axes[c] = (double)along[c];
    look_across(frame->covariance, white, frame->axes + 3);
}
