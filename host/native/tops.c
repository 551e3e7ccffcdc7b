#include "tops.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* Steps across the window that other tops are looked for in. */
enum { WINDOW = 2 * TOPS_FARTHEST + 1 };

/* Rounds of moving to the centroid about a centre, and the step that ends them:
 * a fiftieth of the steps that light is sampled in. */
enum { CORE_ROUNDS = 4 };
#define CORE_SETTLED 0.02
/* Half the width of the ring on which the way to the next lamp is looked at:
 * no step between its two sides is missed. */
#define HALF_RING 0.75

/* A top of the light as smoothed to a width: x, y in steps; error: standard,
 * for noise with a slope of 1; sharpness: bend over height. */
typedef struct {
    double x, y, width, error, sharpness;
} summit_t;

typedef struct {
    int32_t x, y;
    double height;
} place_t;

/* A difference of Gaussians: the light about a place, less its surround. */
static double light_at(const tops_patch_t *patch, int32_t layer, int32_t x,
                       int32_t y)
{
    const ptrdiff_t image = (ptrdiff_t)patch->side * patch->side;
    const float *at =
        patch->smoothed + layer * image + (ptrdiff_t)y * patch->side + x;
    return at[0] - at[2 * image];
}

static double apart(double x, double y, double other_x, double other_y)
{
    return hypot(x - other_x, y - other_y);
}

/* Through 3 x 3 values of a layer; whether they have a top. */
static bool summit_at(const tops_patch_t *patch, int32_t layer, int32_t x,
                      int32_t y, summit_t *summit)
{
    const double height = light_at(patch, layer, x, y);
    const double left = light_at(patch, layer, x - 1, y);
    const double right = light_at(patch, layer, x + 1, y);
    const double up = light_at(patch, layer, x, y - 1);
    const double down = light_at(patch, layer, x, y + 1);
    const double across = 2 * height - left - right;
    const double along = 2 * height - up - down;
    if (!(fmin(fmin(across, along), height) > 0))
        return false;
    const double width = patch->widths[layer];
    *summit = (summit_t){
        .x = x + fmin(fmax(0.5 * (right - left) / across, -1), 1),
        .y = y + fmin(fmax(0.5 * (down - up) / along, -1), 1),
        .width = width,
        /* A top moves by noise's slope over the bend. */
        .error = 1 / (width * width * fmin(across, along)),
        .sharpness = 0.5 * (across + along) / height,
    };
    return true;
}

/* The brightest place within stride of another, the first of equals. */
static place_t brightest(const tops_patch_t *patch, int32_t layer, int32_t x,
                         int32_t y, int32_t stride)
{
    place_t best = {x, y, -INFINITY};
    for (int32_t row = y - stride; row <= y + stride; row++)
        for (int32_t column = x - stride; column <= x + stride; column++) {
            const double height = light_at(patch, layer, column, row);
            if (height > best.height)
                best = (place_t){column, row, height};
        }
    return best;
}

/* The top uphill of the middle; whether there is one within reach. */
static bool climb(const tops_patch_t *patch, int32_t layer, summit_t *summit)
{
    const int32_t middle = patch->side / 2;
    const int32_t stride = (int32_t)fmax(1, rint(patch->widths[layer]));
    place_t at = {middle, middle, 0};
    for (;;) {
        const place_t next = brightest(patch, layer, at.x, at.y, stride);
        if (next.x == at.x && next.y == at.y)
            return summit_at(patch, layer, at.x, at.y, summit);
        at = next;
        if (fmax(fabs((double)at.x - middle), fabs((double)at.y - middle)) >
            patch->reach)
            return false;
    }
}

/* Steps from the summit at one width to that at the next, narrower or wider:
 * the shorter of both ways, for a narrow smoothing is led astray by noise, and
 * one wider than the lamp by what is beside it.  0 where no wider one has a
 * top: then the lamp may be as wide as the widest, and a narrower one finds any
 * place on it. */
static double drift_of(const summit_t *summits, const bool *stands,
                       int32_t count, int32_t best)
{
    if (best + 1 >= count || !stands[best + 1])
        return 0;
    const summit_t *own = summits + best;
    const double wider = apart(own->x, own->y, own[1].x, own[1].y);
    if (best == 0 || !stands[best - 1])
        return wider;
    return fmin(wider, apart(own->x, own->y, own[-1].x, own[-1].y));
}

static tops_top_t top_of(const tops_patch_t *patch, const summit_t *summit,
                         double drift)
{
    const int32_t middle = patch->side / 2;
    const double sharp = patch->step > 1 ? 0
                                         : (summit->sharpness - TOPS_BLUNT) /
                                               (TOPS_SHARP - TOPS_BLUNT);
    const double sampling =
        TOPS_SAMPLING * fmin(fmax(sharp, TOPS_LEAST_SAMPLING), 1);
    const double least = patch->step * TOPS_FLOOR * summit->width;
    const double noise = patch->noise * summit->error;
    return (tops_top_t){
        summit->x - middle,
        summit->y - middle,
        sqrt(sampling * sampling + least * least + noise * noise),
        patch->step * TOPS_DRIFT * drift,
        patch->step * summit->width,
        patch->step * patch->step * summit->error * summit->width *
            summit->width};
}

/* Whether none of the eight places about one is brighter. */
static bool is_top(const tops_patch_t *patch, const place_t *place)
{
    for (int32_t row = place->y - 1; row <= place->y + 1; row++)
        for (int32_t column = place->x - 1; column <= place->x + 1; column++)
            if (light_at(patch, 0, column, row) > place->height)
                return false;
    return true;
}

/* All tops within reach at the least width that are high enough, the highest
 * first, of equals the upper left; how many. */
static int32_t list_others(const tops_patch_t *patch,
                           place_t others[WINDOW * WINDOW])
{
    const int32_t middle = patch->side / 2, reach = (int32_t)patch->reach;
    const float highest =
        (float)brightest(patch, 0, middle, middle, reach).height;
    const float least = (float)TOPS_OTHER * highest;
    int32_t count = 0;
    for (int32_t row = middle - reach; row <= middle + reach; row++)
        for (int32_t column = middle - reach; column <= middle + reach;
             column++) {
            const place_t place = {column, row,
                                   light_at(patch, 0, column, row)};
            if (!(place.height > least) || !is_top(patch, &place))
                continue;
            int32_t at = count++;
            for (; at > 0 && others[at - 1].height < place.height; at--)
                others[at] = others[at - 1];
            others[at] = place;
        }
    return count;
}

int32_t tops_find(const tops_patch_t *patch, tops_top_t *tops)
{
    summit_t summits[TOPS_WIDTHS];
    bool stands[TOPS_WIDTHS];
    int32_t best = -1, found = 0;
    for (int32_t layer = 0; layer < patch->count; layer++) {
        stands[layer] = climb(patch, layer, summits + layer);
        if (stands[layer] &&
            (best < 0 || summits[layer].error < summits[best].error))
            best = layer;
    }
    if (best < 0)
        return 0;
    summit_t own = summits[best];
    /* How sharp the lamp is its narrowest smoothing tells. */
    own.sharpness = stands[0] ? summits[0].sharpness : 0;
    const double drift = drift_of(summits, stands, patch->count, best);
    if (drift > TOPS_MOST_DRIFT)
        return 0;
    tops[found++] = top_of(patch, &own, drift);
    if (patch->count > TOPS_SMALL)
        return found;
    const int32_t middle = patch->side / 2;
    place_t others[WINDOW * WINDOW];
    const int32_t count = list_others(patch, others);
    for (int32_t i = 0; i < count && found < TOPS_MOST; i++) {
        summit_t other;
        bool far = summit_at(patch, 0, others[i].x, others[i].y, &other);
        for (int32_t k = 0; far && k < found; k++)
            far = apart(other.x - middle, other.y - middle, tops[k].x,
                        tops[k].y) > patch->widths[0];
        if (far)
            tops[found++] = top_of(patch, &other, 0);
    }
    return found;
}

/* The brightest light within radius of a centre, and on the ring about it. */
static void look_at_core(const float *light, int32_t side, double radius,
                         double x, double y, double *top, double *ring)
{
    const int32_t middle = side / 2;
    *top = *ring = -INFINITY;
    for (int32_t row = 0; row < side; row++)
        for (int32_t column = 0; column < side; column++) {
            const double value = light[(ptrdiff_t)row * side + column];
            const double far = apart(column - middle, row - middle, x, y);
            if (far < radius)
                *top = fmax(*top, value);
            if (fabs(far - radius) < HALF_RING)
                *ring = fmax(*ring, value);
        }
}

/* The centroid of what is above a level within radius of a centre; whether
 * anything is. */
static bool centroid(const float *light, int32_t side, double radius,
                     double level, double *x, double *y)
{
    const int32_t middle = side / 2;
    double sum = 0, across = 0, down = 0;
    for (int32_t row = 0; row < side; row++)
        for (int32_t column = 0; column < side; column++) {
            const double above = light[(ptrdiff_t)row * side + column] - level;
            if (!(above > 0) ||
                !(apart(column - middle, row - middle, *x, *y) < radius))
                continue;
            sum += above;
            across += above * (column - middle);
            down += above * (row - middle);
        }
    if (!(sum > 0))
        return false;
    *x = across / sum;
    *y = down / sum;
    return true;
}

int32_t tops_core(const float *light, int32_t side, double radius, double *x,
                  double *y)
{
    double at_x = *x, at_y = *y;
    radius = fmin(radius, side / 2);
    for (int32_t round = 0; round < CORE_ROUNDS; round++) {
        const double from_x = at_x, from_y = at_y;
        double top, ring;
        look_at_core(light, side, radius, at_x, at_y, &top, &ring);
        const double level = ring + TOPS_CORE_LEVEL * (top - ring);
        if (!centroid(light, side, radius, level, &at_x, &at_y))
            return -1;
        if (apart(at_x, at_y, from_x, from_y) < CORE_SETTLED)
            break;
    }
    *x = at_x;
    *y = at_y;
    return 0;
}
