#include "search.h"

#include "internal/weighing.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Peaks here are the promising ones, numbered from 0. */
typedef struct {
    frame_t frame;
    const search_dock_t *dock;
    double least;
    double log_places; /* of the frame's places and of the base's turns */
    int32_t count;
    const int32_t *promising;
    double place_x[SEARCH_MAX_PROMISING], place_y[SEARCH_MAX_PROMISING];
    /* Bounds, whatever the other members of a set are: of a peak's rarity and
     * likeness; of the sum of so many peaks'; of the ratio that one peak's
     * (second's) colour is the other's; and of that with any other. */
    double rarity[SEARCH_MAX_PROMISING], rarest[SEARCH_MAX_PROMISING + 1];
    double colour[SEARCH_MAX_PROMISING][SEARCH_MAX_PROMISING];
    double nearest_colour[SEARCH_MAX_PROMISING];
    /* And of what all markers but the first k add to the log density of the
     * strengths. */
    double strengths_left[SEARCH_MAX_PROMISING + 1];
    /* The set: the peaks taken for p, q, ..., their b, and of the base: its
     * displacement over its length squared. */
    int32_t set[SEARCH_MAX_PROMISING];
    double x[SEARCH_MAX_PROMISING], y[SEARCH_MAX_PROMISING];
    double base_x, base_y;
    int32_t weighed, most_weighed; /* sets, complete or not */
    /* What was found, the best first. */
    int32_t most_sets, found;
    int32_t *members;
    double *evidence, *looks;
} search_t;

static const peak_t *peak_at(const search_t *search, int32_t i)
{
    return &search->frame.peaks[search->promising[i]];
}

/* Rarity of a peak at most, with any others in a set of so many. */
static double most_rarity(const frame_t *frame, int32_t index, int32_t size)
{
    const peak_t *peak = &frame->peaks[index];
    int32_t others = size - 1, count = frame->count - size;
    int32_t stronger = index > others ? index - others : 0;
    int32_t nearby = peak->stronger > others ? peak->stronger - others : 0;
    double strongest = count > 0 ? frame->peaks[size].height : 0;
    double most = frame->heights - peak->height, least = frame->heights;
    for (int32_t i = 0; i < size; i++)
        least -= frame->peaks[i].height;
    return larger(
        evidence_rarity(frame, peak, stronger, nearby, count, most, strongest),
        evidence_rarity(frame, peak, stronger, nearby, count, larger(least, 0),
                        strongest));
}

/* Density of clutter's chroma at a peak at least: if all others in a set of so
 * many are of its very colour and as well known as the strongest peak's. */
static double least_clutter_colour(const frame_t *frame, const peak_t *peak,
                                   int32_t size)
{
    double itself = same_colour(peak, peak);
    double others =
        (size - 1) * student(0, peak->variance + frame->peaks[0].variance);
    return evidence_clutter_colour(
        frame, peak, peak->everywhere - itself - others, frame->count - size,
        peak->nearby - itself - others, peak->around - 1);
}

static int descending(const void *a, const void *b)
{
    double one = *(const double *)a, other = *(const double *)b;
    return (one < other) - (one > other);
}

static void prepare_bounds(search_t *search)
{
    const frame_t *frame = &search->frame;
    const evidence_constants_t *constants = frame->constants;
    int32_t markers = search->dock->markers;
    /* The clutter looks least like lamps without those that do most. */
    double sorted[EVIDENCE_MAX_PEAKS] = {0}, ratios = frame->ratios;
    for (int32_t i = 0; i < frame->count; i++)
        sorted[i] = frame->peaks[i].ratio;
    qsort(sorted, (size_t)frame->count, sizeof(double), descending);
    for (int32_t i = 0; i < markers; i++)
        ratios -= sorted[i];
    double usual =
        evidence_log_mean_ratio(frame, frame->count - markers, ratios);
    for (int32_t i = 0; i < search->count; i++) {
        search->rarity[i] = peak_at(search, i)->likeness - usual +
                            most_rarity(frame, search->promising[i], markers);
        search->rarest[i + 1] = search->rarity[i];
        search->nearest_colour[i] = 1;
    }
    search->rarest[0] = 0;
    qsort(search->rarest + 1, (size_t)search->count, sizeof(double),
          descending);
    for (int32_t i = 0; i < search->count; i++)
        search->rarest[i + 1] += search->rarest[i];
    for (int32_t j = 0; j < search->count; j++) {
        const peak_t *peak = peak_at(search, j);
        double clutter = least_clutter_colour(frame, peak, markers);
        for (int32_t i = 0; i < search->count; i++) {
            double same = same_colour(peak_at(search, i), peak);
            double ratio =
                i == j ? 1 : evidence_colour_ratio(frame, same, clutter);
            search->colour[i][j] = ratio;
            search->nearest_colour[i] =
                larger(search->nearest_colour[i], ratio);
        }
    }
    /* Markers that no noise disturbs, all as strong, are as dense as any. */
    double weight = 1 / square(constants->strength_spread), all = 0;
    double log_density = 0.5 * log(weight / (2 * PI));
    strengths_t strengths = {0};
    for (int32_t k = 1; k <= markers; k++) {
        add_strength(&strengths, 0, weight, log_density,
                     search->dock->along[k - 1]);
        all = evidence_log_alike(constants, &strengths);
        search->strengths_left[k] = -all;
    }
    for (int32_t k = 1; k <= markers; k++)
        search->strengths_left[k] += all;
}

/* What strengths, rarity and colours of a set may come to at most, whose first
 * k peaks are known: if the others are the rarest, and of the colour nearest
 * to that of the one that has the dock's. */
static double hoped_looks(search_t *search, int32_t k,
                          const strengths_t *strengths)
{
    int32_t others = search->dock->markers - k;
    search->weighed++;
    double rarity = search->rarest[others], colour = DBL_MIN;
    for (int32_t i = 0; i < k; i++) {
        const double *ratios = search->colour[search->set[i]];
        double common = 1;
        for (int32_t j = 0; j < k; j++)
            common *= ratios[search->set[j]];
        for (int32_t j = 0; j < others; j++)
            common *= search->nearest_colour[search->set[i]];
        colour = larger(colour, common);
        rarity += search->rarity[search->set[i]];
    }
    return evidence_log_alike(search->frame.constants, strengths) +
           search->strengths_left[k] + rarity + log(colour);
}

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
 * expected; strengths: of the set. */
static void extend(search_t *search, int32_t k, int32_t class, double place,
                   const strengths_t *strengths)
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
        if (off >= search->dock->gate || is_in_set(search, k, i))
            continue;
        if (search->weighed >= search->most_weighed)
            return;
        double there = place - 0.5 * off;
        strengths_t sums = *strengths;
        take(search, k, i, x, y, &sums);
        if (there + hoped_looks(search, k + 1, &sums) >= search->least)
            extend(search, k + 1, class, there, &sums);
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

/* Search all sets with a base and a third marker, at x + iy as seen from it. */
static void search_third(search_t *search, const view_t *base, int32_t span,
                         int32_t third, double x, double y)
{
    const search_dock_t *dock = search->dock;
    double looks = 0, place = 0;
    bool known = false;
    strengths_t strengths = {0};
    for (int32_t facet = 0; facet < dock->facets; facet++) {
        int32_t class = span * dock->facets + facet;
        expected_t expected = expect(search, 2, class);
        double off = off_square(&expected, x, y);
        if (off >= dock->gate)
            continue;
        if (search->weighed >= search->most_weighed)
            return;
        if (!known) {
            known = true;
            /* The base is even in log length and normal in direction; each
             * marker's place is as much denser than its b as the base squared
             * is small. */
            place =
                -search->log_places - (dock->markers - 1) * log(base->square);
            take(search, 0, search->set[0], 0, 0, &strengths);
            take(search, 1, base->peak, 1, 0, &strengths);
            take(search, 2, third, x, y, &strengths);
            looks = hoped_looks(search, 3, &strengths);
        }
        double there = place + dock->log_norm[class] - 0.5 * off;
        if (there + looks < search->least)
            continue;
        double turned = atan2(base->across, base->along) / dock->roll_rad;
        there -= 0.5 * square(turned);
        if (there + looks >= search->least)
            extend(search, 3, class, there, &strengths);
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
            if (inside && side->peak != base->peak)
                search_third(search, base, span, side->peak, x, y);
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
    prepare_bounds(&search);
    for (int32_t i = 0; i < search.count; i++) {
        search.place_x[i] = peak_at(&search, i)->x;
        search.place_y[i] = peak_at(&search, i)->y;
    }
    for (int32_t p = 0; p < search.count; p++)
        search_from(&search, p);
    *weighed = search.weighed;
    return search.found;
}
