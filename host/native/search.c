#include "search.h"

#include "internal/vectors.h"
#include "internal/weighing.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* More than what rounding does to a sum of logarithms. */
#define ROUNDING 1e-6

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
     * (first's) colour is the other's; and of that with any other. */
    double rarity[SEARCH_MAX_PROMISING], rarest[SEARCH_MAX_PROMISING + 1];
    double colour[SEARCH_MAX_PROMISING][SEARCH_MAX_PROMISING];
    double nearest_colour[SEARCH_MAX_PROMISING];
    /* Of the log ratio of a set's colours, if this peak has the dock's. */
    double log_colours[SEARCH_MAX_PROMISING];
    /* Of the log density of the strengths of all markers. */
    double strengths;
    /* And of what all markers but the first k add to the log density of the
     * strengths. */
    double strengths_left[SEARCH_MAX_PROMISING + 1];
    /* The set: the peaks taken for p, q, ..., and their b. */
    int32_t set[SEARCH_MAX_PROMISING];
    double x[SEARCH_MAX_PROMISING], y[SEARCH_MAX_PROMISING];
    /* Of all peaks: what b would be. */
    double every_x[SEARCH_MAX_PROMISING], every_y[SEARCH_MAX_PROMISING];
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

/* What the colour of each peak is worth if it is that of each other. */
WIDE_VECTORS static void prepare_colours(search_t *search)
{
    const frame_t *frame = &search->frame;
    const int32_t count = search->count, markers = search->dock->markers;
    const double disturbed = frame->constants->colour_disturbed;
    double x[SEARCH_MAX_PROMISING], y[SEARCH_MAX_PROMISING];
    double variance[SEARCH_MAX_PROMISING];
    for (int32_t i = 0; i < count; i++) {
        x[i] = peak_at(search, i)->chroma_x;
        y[i] = peak_at(search, i)->chroma_y;
        variance[i] = peak_at(search, i)->variance;
        search->nearest_colour[i] = 1;
    }
    for (int32_t j = 0; j < count; j++) {
        const double clutter =
            least_clutter_colour(frame, peak_at(search, j), markers);
        double *restrict ratios = search->colour[j];
        double *restrict nearest = search->nearest_colour;
        for (int32_t i = 0; i < count; i++) {
            const double apart = square(x[i] - x[j]) + square(y[i] - y[j]);
            const double same = student(apart, variance[i] + variance[j]);
            const double ratio = colour_ratio(disturbed, same, clutter);
            ratios[i] = i == j ? 1 : ratio;
            nearest[i] = larger(nearest[i], ratios[i]);
        }
    }
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
    }
    search->rarest[0] = 0;
    qsort(search->rarest + 1, (size_t)search->count, sizeof(double),
          descending);
    for (int32_t i = 0; i < search->count; i++)
        search->rarest[i + 1] += search->rarest[i];
    prepare_colours(search);
    for (int32_t i = 0; i < search->count; i++)
        search->log_colours[i] = (markers - 1) * log(search->nearest_colour[i]);
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
    search->strengths = all;
}

/* What hoped_looks() is at most, told by what is known of each of the first k
 * peaks alone. */
static double most_looks(const search_t *search, int32_t k)
{
    double rarity = search->rarest[search->dock->markers - k];
    double colour = search->log_colours[search->set[0]];
    for (int32_t i = 0; i < k; i++) {
        rarity += search->rarity[search->set[i]];
        colour = larger(colour, search->log_colours[search->set[i]]);
    }
    return search->strengths + rarity + colour + ROUNDING;
}

/* What strengths, rarity and colours of a set may come to at most, whose first
 * k peaks are known: if the others are the rarest, and of the colour nearest
 * to that of the one that has the dock's. */
static double hoped_looks(const search_t *search, int32_t k,
                          const strengths_t *strengths)
{
    int32_t others = search->dock->markers - k;
    double rarity = search->rarest[others], colour = DBL_MIN;
    for (int32_t i = 0; i < k; i++) {
        double common = 1;
        for (int32_t j = 0; j < k; j++)
            common *= search->colour[search->set[j]][search->set[i]];
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
    const peak_t *peak = peak_at(search, i);
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
    const int32_t all = search->count;
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
 * expected; strengths: of the set. */
static void extend(search_t *search, int32_t k, int32_t class, double place,
                   const strengths_t *strengths)
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
        if (is_in_set(search, k, i))
            continue;
        if (search->weighed >= search->most_weighed)
            return;
        double there = place - 0.5 * off;
        strengths_t sums = *strengths;
        take(search, k, i, x, y, &sums);
        search->weighed++;
        if (there + hoped_looks(search, k + 1, &sums) >= search->least)
            extend(search, k + 1, class, there, &sums);
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
    const int32_t all = search->count;
    const double slack = search->dock->slack;
    const double shortest = square(larger(window->shortest - slack, 0));
    const double longest = square(window->longest + slack);
    const double from_x = search->place_x[from], from_y = search->place_y[from];
    const double right = window->x, down = window->y, slope = window->slope;
    double squares[SEARCH_MAX_PROMISING];
    int64_t held[SEARCH_MAX_PROMISING];
    for (int32_t i = 0; i < all; i++) {
        const double x = search->place_x[i] - from_x;
        const double y = search->place_y[i] - from_y;
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
        views->x[count] = search->place_x[i] - from_x;
        views->y[count] = search->place_y[i] - from_y;
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
    double from_x = search->place_x[search->set[0]];
    double from_y = search->place_y[search->set[0]];
    for (int32_t i = 0; i < search->count; i++) {
        double x = search->place_x[i] - from_x;
        double y = search->place_y[i] - from_y;
        search->every_x[i] = x * right + y * down;
        search->every_y[i] = y * right - x * down;
    }
    base->turn = -0.5 * square(atan2(across, along) / search->dock->roll_rad);
    base->seen = true;
}

/* Search all sets with a base and a third marker, at x + iy as seen from it. */
static void search_third(search_t *search, base_t *base, int32_t third,
                         double x, double y)
{
    const search_dock_t *dock = search->dock;
    double looks = 0, most = 0;
    bool counted = false, known = false;
    strengths_t strengths = {0};
    const int32_t first = base->span * dock->facets;
    const int32_t wide = 2 * (dock->markers - 2);
    const double *offset = dock->offset + first * wide;
    const double *whiten = dock->whiten + first * wide * wide;
    for (int32_t facet = 0; facet < dock->facets;
         facet++, offset += wide, whiten += wide * wide) {
        expected_t expected = expect(search, 2, offset, whiten);
        double off = off_square(&expected, x, y);
        if (off >= dock->gate)
            continue;
        if (search->weighed >= search->most_weighed)
            return;
        if (!counted) {
            counted = true;
            search->weighed++;
            search->set[1] = base->q;
            search->set[2] = third;
            most = most_looks(search, 3);
        }
        double there = base->place + dock->log_norm[first + facet] - 0.5 * off;
        /* Few have to be looked at closely. */
        if (there + most < search->least)
            continue;
        if (!known) {
            known = true;
            take(search, 0, search->set[0], 0, 0, &strengths);
            take(search, 1, base->q, 1, 0, &strengths);
            take(search, 2, third, x, y, &strengths);
            looks = hoped_looks(search, 3, &strengths);
        }
        if (there + looks < search->least)
            continue;
        if (!base->seen)
            see_from(search, base);
        there += base->turn;
        if (there + looks >= search->least)
            extend(search, 3, first + facet, there, &strengths);
    }
}

/* Search all sets with a base, and one of the sides' ends as third marker. */
WIDE_VECTORS static void search_base(search_t *search, base_t *base,
                                     const views_t *sides)
{
    const search_box_t box = search->dock->thirds[base->span];
    const double base_x = base->x / base->square;
    const double base_y = base->y / base->square;
    const int32_t count = sides->count;
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
    for (int32_t j = 0; j < count; j++)
        if (inside[j] && sides->peak[j] != base->q)
            search_third(search, base, sides->peak[j], x[j], y[j]);
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
        while (base.span < dock->spans - 1 &&
               square(dock->edges[base.span]) < base.square)
            base.span++;
        search_base(search, &base, &sides);
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
