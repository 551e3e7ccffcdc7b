#include "internal/searching.h"
#include "internal/vectors.h"

#include <math.h>
#include <string.h>

/* Keep the complete set with that log density of its places, if it is among
 * the best. */
static void keep(search_t *search, double place)
{
    int32_t markers = search->dock->markers, set[SEARCH_MAX_PROMISING];
    size_t size = (size_t)markers * sizeof *set;
    for (int32_t k = 0; k < markers; k++)
        set[k] = search->bounds->promising[search->set[k]];
    double looks = evidence_of_set(search->bounds->frame, markers, set,
                                   search->dock->along);
    double evidence = place + looks;
    if (evidence < search->least)
        return;
    /* The same peaks may be a view from more than one side. */
    int32_t at = 0;
    while (at < search->found &&
           memcmp(search->members + at * markers, set, size) != 0)
        at++;
    if (at < search->found) {
        if (evidence <= search->evidence[at])
            return;
    } else if (search->found < search->most_sets) {
        search->found++;
    } else {
        at--;
    }
    for (; at > 0 && search->evidence[at - 1] < evidence; at--) {
        memcpy(search->members + at * markers,
               search->members + (at - 1) * markers, size);
        search->evidence[at] = search->evidence[at - 1];
        search->looks[at] = search->looks[at - 1];
    }
    memcpy(search->members + at * markers, set, size);
    search->evidence[at] = evidence;
    search->looks[at] = looks;
    if (search->found == search->most_sets)
        search->least = search->evidence[search->found - 1];
}

static bool is_in_set(const search_t *search, int32_t k, int32_t peak)
{
    for (int32_t i = 0; i < k; i++)
        if (search->set[i] == peak)
            return true;
    return false;
}

/* The two components of w that the k-th marker adds, as they depend on its
 * b = x + iy: u + ux x and v + vx x + vy y.  offset, whiten: of a class of
 * views. */
typedef struct {
    double u, v, ux, vx, vy;
} expected_t;

static expected_t expect(const search_t *search, int32_t k,
                         const double *offset, const double *whiten)
{
    int32_t row = 2 * (k - 2), wide = 2 * (search->dock->markers - 2);
    const double *by_u = whiten + row * wide, *by_v = by_u + wide;
    expected_t w = {.u = offset[row],
                    .v = offset[row + 1],
                    .ux = by_u[row],
                    .vx = by_v[row],
                    .vy = by_v[row + 1]};
    for (int32_t i = 2; i < k; i++) {
        double x = search->x[i], y = search->y[i];
        w.u += by_u[2 * i - 4] * x + by_u[2 * i - 3] * y;
        w.v += by_v[2 * i - 4] * x + by_v[2 * i - 3] * y;
    }
    return w;
}

static double off_square(const expected_t *w, double x, double y)
{
    return square(w->u + w->ux * x) + square(w->v + w->vx * x + w->vy * y);
}

/* Take a peak for the k-th marker. */
static void take(search_t *search, int32_t k, int32_t i, double x, double y,
                 strengths_t *strengths)
{
    const peak_t *peak = bounds_peak(search->bounds, i);
    add_strength(strengths, peak->log_snr, peak->weight, peak->log_density,
                 search->dock->along[k]);
    search->set[k] = i;
    search->x[k] = x;
    search->y[k] = y;
}

/* List the peaks that may be a marker, by where it is expected; returns how
 * many they are. */
WIDE_VECTORS static int32_t list_expected(const search_t *search,
                                          const expected_t *expected,
                                          uint8_t peaks[SEARCH_MAX_PROMISING])
{
    const expected_t w = *expected;
    const double gate = search->dock->gate;
    const int32_t all = search->bounds->count;
    int64_t within[SEARCH_MAX_PROMISING];
    for (int32_t i = 0; i < all; i++)
        within[i] =
            off_square(&w, search->every_x[i], search->every_y[i]) < gate;
    int32_t count = 0;
    for (int32_t i = 0; i < all; i++) {
        peaks[count] = (uint8_t)i;
        count += (int32_t)within[i];
    }
    return count;
}

/* Add all markers from the k-th on to a set, in a class of views.
 *
 * place: log density of the places if these markers are right where they are
 * expected; looks: what all else may come to; strengths: of the set. */
static void extend(search_t *search, int32_t k, int32_t class, double place,
                   double looks, const strengths_t *strengths)
{
    if (k == search->dock->markers) {
        keep(search, place);
        return;
    }
    const int32_t wide = 2 * (search->dock->markers - 2);
    expected_t expected = expect(search, k, search->dock->offset + class * wide,
                                 search->dock->whiten + class * wide * wide);
    uint8_t peaks[SEARCH_MAX_PROMISING];
    int32_t count = list_expected(search, &expected, peaks);
    for (int32_t j = 0; j < count; j++) {
        int32_t i = peaks[j];
        double x = search->every_x[i], y = search->every_y[i];
        double off = off_square(&expected, x, y);
        double there = place - 0.5 * off;
        if (is_in_set(search, k, i) ||
            there + bounds_looks_with(search, looks, k, i) < search->least)
            continue;
        if (search->weighed >= search->most_weighed)
            return;
        search->weighed++;
        strengths_t sums = *strengths;
        take(search, k, i, x, y, &sums);
        double most = bounds_looks(search, k + 1, &sums);
        if (there + most >= search->least)
            extend(search, k + 1, class, there, most, &sums);
    }
}

/* Promising peaks as seen from one of them: their displacements, and the
 * squares of these. */
typedef struct {
    int32_t count;
    int32_t peak[SEARCH_MAX_PROMISING];
    double x[SEARCH_MAX_PROMISING], y[SEARCH_MAX_PROMISING];
    double square[SEARCH_MAX_PROMISING];
} views_t;

/* List those that a window holds. */
WIDE_VECTORS static void views_from(const search_t *search, int32_t from,
                                    const search_window_t *window,
                                    views_t *views)
{
    const int32_t all = search->bounds->count;
    const double slack = search->dock->slack;
    const double shortest = square(larger(window->shortest - slack, 0));
    const double longest = square(window->longest + slack);
    const double from_x = search->bounds->place_x[from],
                 from_y = search->bounds->place_y[from];
    const double right = window->x, down = window->y, slope = window->slope;
    double squares[SEARCH_MAX_PROMISING];
    int64_t held[SEARCH_MAX_PROMISING];
    for (int32_t i = 0; i < all; i++) {
        const double x = search->bounds->place_x[i] - from_x;
        const double y = search->bounds->place_y[i] - from_y;
        const double along = x * right + y * down;
        const double across = y * right - x * down;
        squares[i] = x * x + y * y;
        held[i] = (fabs(across) < slope * along + slack) &
                  (squares[i] > shortest) & (squares[i] < longest);
    }
    int32_t count = 0;
    /* Without a branch, for nobody could foretell it. */
    for (int32_t i = 0; i < all; i++) {
        views->peak[count] = i;
        views->x[count] = search->bounds->place_x[i] - from_x;
        views->y[count] = search->bounds->place_y[i] - from_y;
        views->square[count] = squares[i];
        count += (int32_t)held[i];
    }
    views->count = count;
}

/* The two markers of the base, from p to q, and log densities: of the places,
 * but for the shape and for how the base is turned, and of the latter over that
 * of an upright one.  seen: whether that is known, and every peak's b. */
typedef struct {
    int32_t q, span;
    double x, y, square, place, turn;
    bool seen;
} base_t;

/* Tell what is needed only where a third marker fits. */
static void see_from(search_t *search, base_t *base)
{
    const search_window_t *window = &search->dock->base;
    double along = base->x * window->x + base->y * window->y;
    double across = base->y * window->x - base->x * window->y;
    double right = base->x / base->square, down = base->y / base->square;
    double from_x = search->bounds->place_x[search->set[0]];
    double from_y = search->bounds->place_y[search->set[0]];
    for (int32_t i = 0; i < search->bounds->count; i++) {
        double x = search->bounds->place_x[i] - from_x;
        double y = search->bounds->place_y[i] - from_y;
        search->every_x[i] = x * right + y * down;
        search->every_y[i] = y * right - x * down;
    }
    base->turn = -0.5 * square(atan2(across, along) / search->dock->roll_rad);
    base->seen = true;
}

/* Tell which facets a third marker at x + iy, as seen from the base, may be
 * seen in where all but places comes to `most`, and the log density of the
 * places there; returns whether there are any. */
static inline bool list_facets(const search_t *search, const base_t *base,
                               double x, double y, double most,
                               double there[SEARCH_MAX_FACETS],
                               int64_t fits[SEARCH_MAX_FACETS])
{
    const search_third_t *third = &search->dock->thirds[base->span];
    const double place = base->place, gate = search->dock->gate;
    const double least = search->least;
    int64_t any = 0;
    /* Unrolled, it would not be made of vector instructions. */
#pragma GCC unroll 1
    for (int32_t k = 0; k < SEARCH_MAX_FACETS; k++) {
        const double off =
            square(third->u[k] + third->ux[k] * x) +
            square(third->v[k] + third->vx[k] * x + third->vy[k] * y);
        there[k] = place + third->log_norm[k] - 0.5 * off;
        fits[k] = (off < gate) & (there[k] + most >= least);
        any |= fits[k];
    }
    return any != 0;
}

/* Search all sets with a base and a third marker, at x + iy as seen from it, in
 * the facets that it fits. */
static void search_third(search_t *search, base_t *base, double x, double y,
                         const double there[SEARCH_MAX_FACETS],
                         const int64_t fits[SEARCH_MAX_FACETS])
{
    const search_dock_t *dock = search->dock;
    if (search->weighed >= search->most_weighed)
        return;
    search->weighed++;
    strengths_t strengths = {0};
    take(search, 0, search->set[0], 0, 0, &strengths);
    take(search, 1, base->q, 1, 0, &strengths);
    take(search, 2, search->set[2], x, y, &strengths);
    const double looks = bounds_looks(search, 3, &strengths);
    for (int32_t facet = 0; facet < dock->facets; facet++) {
        if (!fits[facet] || there[facet] + looks < search->least)
            continue;
        if (!base->seen)
            see_from(search, base);
        const double place = there[facet] + base->turn;
        if (place + looks >= search->least)
            extend(search, 3, base->span * dock->facets + facet, place, looks,
                   &strengths);
    }
}

/* Search all sets with a base, and one of the sides' ends as third marker. */
WIDE_VECTORS static void search_base(search_t *search, base_t *base,
                                     const views_t *sides)
{
    const search_box_t box = search->dock->boxes[base->span];
    const double base_x = base->x / base->square;
    const double base_y = base->y / base->square;
    const int32_t count = sides->count;
    const double *rarity = search->bounds->rarity;
    double x[SEARCH_MAX_PROMISING], y[SEARCH_MAX_PROMISING];
    int64_t inside[SEARCH_MAX_PROMISING], any = 0;
    for (int32_t j = 0; j < count; j++) {
        x[j] = sides->x[j] * base_x + sides->y[j] * base_y;
        y[j] = sides->y[j] * base_x - sides->x[j] * base_y;
        inside[j] = (x[j] > box.left) & (x[j] < box.right) & (y[j] > box.top) &
                    (y[j] < box.bottom);
        any |= inside[j];
    }
    if (!any)
        return;
    /* The base is even in log length and normal in direction; each marker's
     * place is as much denser than its b as the base squared is small. */
    base->place =
        -search->log_places - (search->dock->markers - 1) * log(base->square);
    /* What the evidence may come to, but for the rarity of the third. */
    const double most = base->place + search->dock->most_norm[base->span] +
                        search->beside + rarity[search->set[0]] +
                        rarity[base->q];
    search->set[1] = base->q;
    for (int32_t j = 0; j < count; j++) {
        const int32_t third = sides->peak[j];
        if (!inside[j] || third == base->q ||
            most + rarity[third] < search->least)
            continue;
        double there[SEARCH_MAX_FACETS];
        int64_t fits[SEARCH_MAX_FACETS];
        search->set[2] = third;
        /* Few have to be looked at closely. */
        if (list_facets(search, base, x[j], y[j], bounds_most_looks(search, 3),
                        there, fits))
            search_third(search, base, x[j], y[j], there, fits);
    }
}

/* Search all sets whose first marker is at a peak. */
static void search_from(search_t *search, int32_t p)
{
    const search_dock_t *dock = search->dock;
    views_t sides, bases;
    views_from(search, p, &dock->side, &sides);
    if (sides.count == 0)
        return;
    views_from(search, p, &dock->base, &bases);
    search->set[0] = p;
    for (int32_t i = 0; i < bases.count; i++) {
        base_t base = {bases.peak[i],   0, bases.x[i], bases.y[i],
                       bases.square[i], 0, 0,          false};
        /* Without a branch, for nobody could foretell it. */
        for (int32_t k = 0; k < dock->spans - 1; k++)
            base.span += square(dock->edges[k]) < base.square;
        search_base(search, &base, &sides);
    }
}

int32_t search_find(const search_dock_t *dock, const search_bounds_t *bounds,
                    double least, int32_t most_sets, int32_t most_weighed,
                    int32_t *members, double *evidence, double *looks,
                    int32_t *weighed)
{
    *weighed = 0;
    if (bounds->count < dock->markers)
        return 0;
    search_t search = {
        .bounds = bounds,
        .dock = dock,
        .least = least,
        .log_places = log(bounds->frame->area) + dock->log_spread,
        .most_weighed = most_weighed,
        .most_sets = most_sets,
        .members = members,
        .evidence = evidence,
        .looks = looks,
    };
    bounds_of_strengths(&search);
    search.beside = bounds_beside(&search, 3);
    for (int32_t p = 0; p < bounds->count; p++)
        search_from(&search, p);
    *weighed = search.weighed;
    return search.found;
}
