#include "internal/searching.h"

#include <math.h>
#include <string.h>

/* Keep the complete set with that log density of its places, if it is among
 * the best. */
static void keep(search_t *search, double place)
{
    int32_t markers = search->dock->markers, set[SEARCH_MAX_PROMISING];
    size_t size = (size_t)markers * sizeof *set;
    for (int32_t k = 0; k < markers; k++)
        set[k] = search->promising[search->set[k]];
    double looks =
        evidence_of_set(&search->frame, markers, set, search->dock->along);
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
 * b = x + iy: u + ux x and v + vx x + vy y. */
typedef struct {
    double u, v, ux, vx, vy;
} expected_t;

static expected_t expect(const search_t *search, int32_t k, int32_t class)
{
    const search_dock_t *dock = search->dock;
    int32_t row = 2 * (k - 2), wide = 2 * (dock->markers - 2);
    const double *by_u = dock->whiten + (class * wide + row) * wide;
    const double *by_v = by_u + wide;
    expected_t w = {.u = dock->offset[class * wide + row],
                    .v = dock->offset[class * wide + row + 1],
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
    const peak_t *peak = peak_at(search, i);
    add_strength(strengths, peak->log_snr, peak->weight, peak->log_density,
                 search->dock->along[k]);
    search->set[k] = i;
    search->x[k] = x;
    search->y[k] = y;
}

/* Add all markers from the k-th on to a set, in a class of views.
 *
 * place: log density of the places if these markers are right where they are
 * expected; hoped: what all else may come to; strengths: of the set. */
static void extend(search_t *search, int32_t k, int32_t class, double place,
                   double hoped, const strengths_t *strengths)
{
    if (k == search->dock->markers) {
        keep(search, place);
        return;
    }
    expected_t expected = expect(search, k, class);
    double first_x = search->place_x[search->set[0]];
    double first_y = search->place_y[search->set[0]];
    for (int32_t i = 0; i < search->count; i++) {
        double dx = search->place_x[i] - first_x;
        double dy = search->place_y[i] - first_y;
        double x = dx * search->base_x + dy * search->base_y;
        double y = dy * search->base_x - dx * search->base_y;
        double off = off_square(&expected, x, y);
        double there = place - 0.5 * off;
        if (off >= search->dock->gate || is_in_set(search, k, i) ||
            there + search_hoped_with(search, hoped, k, i) < search->least)
            continue;
        if (search->weighed >= search->most_weighed)
            return;
        search->weighed++;
        strengths_t sums = *strengths;
        take(search, k, i, x, y, &sums);
        double looks = search_hoped(search, k + 1, &sums);
        if (there + looks >= search->least)
            extend(search, k + 1, class, there, looks, &sums);
    }
}

/* A displacement, its square, and its components along and across a window's
 * direction. */
typedef struct {
    int32_t peak;
    double x, y, square, along, across;
} view_t;

/* List the promising peaks that a window holds as seen from one of them. */
static int32_t views_from(const search_t *search, int32_t from,
                          const search_window_t *window, view_t *views)
{
    double slack = search->dock->slack;
    double shortest = square(larger(window->shortest - slack, 0));
    double longest = square(window->longest + slack);
    int32_t count = 0;
    for (int32_t i = 0; i < search->count; i++) {
        view_t view = {.peak = i,
                       .x = search->place_x[i] - search->place_x[from],
                       .y = search->place_y[i] - search->place_y[from]};
        view.square = view.x * view.x + view.y * view.y;
        view.along = view.x * window->x + view.y * window->y;
        view.across = view.y * window->x - view.x * window->y;
        views[count] = view;
        /* Without a branch, for nobody could foretell it. */
        count += (fabs(view.across) < window->slope * view.along + slack) &
                 (view.square > shortest) & (view.square < longest);
    }
    return count;
}

/* Take two peaks for the base: returns the log density of the places of all
 * markers, but for their shape.  The base is even in log length and normal in
 * direction; each marker's place is as much denser than its b as the base
 * squared is small. */
static double take_base(search_t *search, const view_t *base,
                        strengths_t *strengths)
{
    const search_dock_t *dock = search->dock;
    double turned = atan2(base->across, base->along) / dock->roll_rad;
    take(search, 0, search->set[0], 0, 0, strengths);
    take(search, 1, base->peak, 1, 0, strengths);
    return -search->log_places - (dock->markers - 1) * log(base->square) -
           0.5 * square(turned);
}

/* Search all sets with a base and a third marker, at x + iy as seen from it.
 *
 * place: log density of the places but for the shape; hoped: what all else may
 * come to; pair: strengths of the base. */
static void search_third(search_t *search, double place, double hoped,
                         const strengths_t *pair, int32_t span, int32_t third,
                         double x, double y)
{
    const search_dock_t *dock = search->dock;
    double most = place + search_hoped_with(search, hoped, 2, third), looks = 0;
    bool known = false;
    strengths_t strengths = *pair;
    for (int32_t facet = 0; facet < dock->facets; facet++) {
        int32_t class = span * dock->facets + facet;
        expected_t expected = expect(search, 2, class);
        double off = off_square(&expected, x, y);
        double shape = dock->log_norm[class] - 0.5 * off;
        if (off >= dock->gate || most + shape < search->least)
            continue;
        if (search->weighed >= search->most_weighed)
            return;
        if (!known) {
            known = true;
            search->weighed++;
            take(search, 2, third, x, y, &strengths);
            looks = search_hoped(search, 3, &strengths);
        }
        if (place + shape + looks >= search->least)
            extend(search, 3, class, place + shape, looks, &strengths);
    }
}

/* Search all sets whose first marker is at a peak. */
static void search_from(search_t *search, int32_t p)
{
    const search_dock_t *dock = search->dock;
    view_t sides[SEARCH_MAX_PROMISING], bases[SEARCH_MAX_PROMISING];
    int32_t sides_count = views_from(search, p, &dock->side, sides);
    int32_t bases_count = 0;
    if (sides_count > 0)
        bases_count = views_from(search, p, &dock->base, bases);
    search->set[0] = p;
    for (int32_t i = 0; i < bases_count; i++) {
        const view_t *base = &bases[i];
        int32_t span = 0;
        while (span < dock->spans - 1 &&
               square(dock->edges[span]) < base->square)
            span++;
        const search_box_t *box = &dock->thirds[span];
        strengths_t pair = {0};
        double place = 0, hoped = 0;
        bool taken = false;
        search->base_x = base->x / base->square;
        search->base_y = base->y / base->square;
        for (int32_t j = 0; j < sides_count; j++) {
            const view_t *side = &sides[j];
            double x = side->x * search->base_x + side->y * search->base_y;
            double y = side->y * search->base_x - side->x * search->base_y;
            /* One branch that is seldom taken in place of five that nobody can
             * foretell. */
            const int inside = (x > box->left) & (x < box->right) &
                               (y > box->top) & (y < box->bottom);
            if (!inside || side->peak == base->peak)
                continue;
            if (!taken) {
                taken = true;
                place = take_base(search, base, &pair);
                hoped = search_hoped(search, 2, &pair);
                if (place + dock->densest[span] + hoped < search->least)
                    break;
            }
            search_third(search, place, hoped, &pair, span, side->peak, x, y);
        }
    }
}

int32_t search_find(const evidence_constants_t *constants,
                    const search_dock_t *dock, const evidence_peaks_t *peaks,
                    int32_t promising_count, const int32_t *promising,
                    double least, int32_t most_sets, int32_t most_weighed,
                    int32_t *members, double *evidence, double *looks,
                    int32_t *weighed)
{
    search_t search;
    *weighed = 0;
    if (peaks->count > EVIDENCE_MAX_PEAKS ||
        promising_count > SEARCH_MAX_PROMISING)
        return -1;
    if (promising_count < dock->markers || most_sets < 1)
        return 0;
    evidence_prepare(&search.frame, constants, peaks);
    search.dock = dock;
    search.least = least;
    search.count = promising_count;
    search.promising = promising;
    search.log_places = log(peaks->area) + dock->log_spread;
    search.weighed = 0;
    search.most_weighed = most_weighed;
    search.most_sets = most_sets;
    search.found = 0;
    search.members = members;
    search.evidence = evidence;
    search.looks = looks;
    search_prepare_bounds(&search);
    for (int32_t i = 0; i < search.count; i++) {
        search.place_x[i] = peak_at(&search, i)->x;
        search.place_y[i] = peak_at(&search, i)->y;
    }
    for (int32_t p = 0; p < search.count; p++)
        search_from(&search, p);
    *weighed = search.weighed;
    return search.found;
}
