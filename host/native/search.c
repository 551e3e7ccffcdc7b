#include "search.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* ---- What strengths and colours say ---- */

/* A peak, and what depends on it alone or on it and all others. */
typedef struct {
    double x, y;
    double likeness, ratio; /* and its exponential */
    double log_snr, weight; /* of the log strength, one over its variance */
    double log_density;     /* of the log strength, at its mean */
    double height;          /* log of the strength over the least known */
    double around_area;     /* of its neighbourhood, as far as it is in view */
    double chroma_x, chroma_y, variance;
    double supposed; /* density of its chroma if nothing is known */
    /* Sums of the density of its chroma if its colour is another's, and how
     * many those nearby are: all with itself. */
    double everywhere, nearby;
    int32_t around;
    int32_t stronger; /* how many of those nearby are stronger */
} peak_t;

typedef struct {
    const evidence_constants_t *constants;
    int32_t count;
    double area, near_square;
    double heights, ratios; /* sums of all */
    peak_t peaks[SEARCH_MAX_PEAKS];
} frame_t;

static double square(double x)
{
    return x * x;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

/* Density of Student's distribution in the plane with two degrees of freedom,
 * at a squared distance: noise's middle and glints' tails. */
static double student(double distance_square, double variance)
{
    return variance / (2 * PI * square(variance + 0.5 * distance_square));
}

/* Density of the chroma of one peak if its colour is the other's. */
static double same_colour(const peak_t *one, const peak_t *other)
{
    double apart = square(one->chroma_x - other->chroma_x) +
                   square(one->chroma_y - other->chroma_y);
    return student(apart, one->variance + other->variance);
}

static bool are_near(const frame_t *frame, const peak_t *one,
                     const peak_t *other)
{
    return square(one->x - other->x) + square(one->y - other->y) <
           frame->near_square;
}

static void prepare_frame(frame_t *frame, const evidence_constants_t *constants,
                          const evidence_peaks_t *peaks)
{
    frame->constants = constants;
    frame->count = peaks->count;
    frame->area = peaks->area;
    frame->near_square = square(constants->clutter_neighbourhood) * peaks->area;
    frame->heights = frame->ratios = 0;
    for (int32_t i = 0; i < peaks->count; i++) {
        peak_t *peak = &frame->peaks[i];
        double noise = 1 / peaks->snr[i];
        peak->x = peaks->places[2 * i];
        peak->y = peaks->places[2 * i + 1];
        peak->likeness = peaks->likeness[i];
        peak->ratio = exp(peak->likeness);
        peak->log_snr = log(peaks->snr[i]);
        peak->weight = 1 / (square(constants->strength_spread) + square(noise));
        peak->log_density = 0.5 * log(peak->weight / (2 * PI));
        peak->height = larger(peak->log_snr - log(peaks->least_snr), 0);
        peak->around_area = PI * frame->near_square * peaks->inside[i];
        peak->chroma_x = peaks->chroma[2 * i];
        peak->chroma_y = peaks->chroma[2 * i + 1];
        peak->variance = square(constants->colour_spread) +
                         square(constants->colour_noise * noise);
        peak->supposed =
            student(square(peak->chroma_x) + square(peak->chroma_y),
                    square(constants->colour_wide) + peak->variance);
        peak->everywhere = peak->nearby = same_colour(peak, peak);
        peak->around = 1;
        peak->stronger = 0;
        frame->heights += peak->height;
        frame->ratios += peak->ratio;
        for (int32_t j = 0; j < i; j++) {
            peak_t *other = &frame->peaks[j];
            double same = same_colour(peak, other);
            peak->everywhere += same;
            other->everywhere += same;
            if (are_near(frame, peak, other)) {
                peak->nearby += same;
                other->nearby += same;
                peak->around++;
                other->around++;
                peak->stronger++;
            }
        }
    }
}

/* Sums over the members of a set for the regression of their log strengths v
 * on their places along the dock t, value = common + slope t: with weights u
 * they are of u, u t, u t^2, u v, u v t, u v^2, and of the log densities. */
typedef struct {
    double u, ut, utt, uv, uvt, uvv, log_density;
} strengths_t;

static void add_strength(strengths_t *sums, double value, double weight,
                         double log_density, double along)
{
    sums->u += weight;
    sums->ut += weight * along;
    sums->utt += weight * along * along;
    sums->uv += weight * value;
    sums->uvt += weight * value * along;
    sums->uvv += weight * value * value;
    sums->log_density += log_density;
}

/* Log density of the log strengths of markers: the integral over the common
 * value, which is evenly spread, and the slope, which is normal, of the product
 * of normal densities about them. */
static double log_alike(const evidence_constants_t *constants,
                        const strengths_t *s)
{
    double utt = s->utt + 1 / square(constants->strength_slope);
    double determinant = s->u * utt - s->ut * s->ut;
    double explained = (utt * s->uv * s->uv - 2 * s->ut * s->uv * s->uvt +
                        s->u * s->uvt * s->uvt) /
                       determinant;
    double scale = constants->strength_slope * constants->strength_log_range;
    return s->log_density - 0.5 * (s->uvv - explained) -
           0.5 * log(determinant * square(scale) / (2 * PI));
}

/* Minus the log density of clutter, a square pixel and unit of log strength,
 * at a peak of some height that `stronger` and `nearby` others exceed, all
 * over and nearby, among `count` others whose heights add up to `total` and
 * are `strongest` at most.
 *
 * Heights are taken to be exponential, with an exponent whose gamma
 * distribution was updated by those of the others: then the share beyond a
 * height y is (b / (b + y))^a (Lomax, J. Am. Stat. Assoc. 49 (1954) 847), and
 * the density there is a / (b + y) times the number beyond it.  That number is
 * the local count, together with one more peak in as much area as holds one
 * stronger peak in all the frame: the mean of a gamma distribution after that
 * count.  What outshines all others is the rarer for it, to a limit. */
static double rarity(const frame_t *frame, const peak_t *peak, int32_t stronger,
                     int32_t nearby, int32_t count, double total,
                     double strongest)
{
    const evidence_constants_t *constants = frame->constants;
    double height = peak->height;
    double a = constants->clutter_supposed + (count > 0 ? count : 0);
    double b =
        constants->clutter_supposed / constants->clutter_exponent + total;
    double expected = stronger + 1;
    if (stronger == 0) {
        double fall = pow((b + strongest) / (b + height), a);
        expected = larger(fall < 1 ? fall : 1, constants->clutter_most_fall);
    }
    double density =
        (nearby + 1) / (peak->around_area + frame->area / expected);
    return -log(a / (b + height) * density);
}

/* Density of clutter's chroma at a peak: the mean of the densities about the
 * others nearby (Parzen, Ann. Math. Statist. 33 (1962) 1065), as of rocks or
 * of a wall; as far as there are few, about those everywhere; and where these
 * are few, what is supposed. */
static double clutter_colour(const frame_t *frame, const peak_t *peak,
                             double everywhere, int32_t count, double nearby,
                             int32_t around)
{
    double supposed = frame->constants->colour_supposed;
    double overall = (larger(everywhere, 0) + supposed * peak->supposed) /
                     (count + supposed);
    return (larger(nearby, 0) + supposed * overall) / (around + supposed);
}

/* Likelihood ratio that a peak has a marker's colour, which makes its chroma
 * so dense, where clutter's is so dense. */
static double colour_ratio(const frame_t *frame, double same, double clutter)
{
    double disturbed = frame->constants->colour_disturbed;
    return (1 - disturbed) * same / clutter + disturbed;
}

/* Sum of the rarities of a set, whose members are no clutter. */
static double set_rarity(const frame_t *frame, int32_t size,
                         const int32_t *members)
{
    int32_t stronger[SEARCH_MAX_PEAKS], nearby[SEARCH_MAX_PEAKS], first = 0;
    double total = frame->heights, sum = 0;
    for (int32_t i = 0; i < size; i++) {
        const peak_t *peak = &frame->peaks[members[i]];
        stronger[i] = members[i];
        nearby[i] = peak->stronger;
        for (int32_t j = 0; j < size; j++)
            if (members[j] < members[i]) {
                stronger[i]--;
                nearby[i] -= are_near(frame, peak, &frame->peaks[members[j]]);
            }
        total -= peak->height;
        first += stronger[i] == 0;
    }
    /* The strongest of the others comes after those members that none of them
     * is stronger than. */
    double strongest = first < frame->count ? frame->peaks[first].height : 0;
    for (int32_t i = 0; i < size; i++)
        sum += rarity(frame, &frame->peaks[members[i]], stronger[i], nearby[i],
                      frame->count - size, total, strongest);
    return sum;
}

/* Log likelihood ratio that a set has one colour in common: of the mean of the
 * ratios with each member for the one that has the dock's. */
static double set_colour(const frame_t *frame, int32_t size,
                         const int32_t *members)
{
    double clutter[SEARCH_MAX_PEAKS], sum = 0;
    for (int32_t j = 0; j < size; j++) {
        const peak_t *peak = &frame->peaks[members[j]];
        double everywhere = peak->everywhere, nearby = peak->nearby;
        int32_t around = peak->around;
        for (int32_t i = 0; i < size; i++) {
            const peak_t *other = &frame->peaks[members[i]];
            double same = same_colour(peak, other);
            everywhere -= same;
            if (are_near(frame, peak, other)) {
                nearby -= same;
                around--;
            }
        }
        clutter[j] = clutter_colour(frame, peak, everywhere,
                                    frame->count - size, nearby, around);
    }
    for (int32_t i = 0; i < size; i++) {
        double product = 1;
        for (int32_t j = 0; j < size; j++)
            if (j != i)
                product *= colour_ratio(frame,
                                        same_colour(&frame->peaks[members[i]],
                                                    &frame->peaks[members[j]]),
                                        clutter[j]);
        sum += product;
    }
    return log(sum / size);
}

/* Log of the mean likelihood ratio of the clutter's looks, where `count` peaks'
 * add up to `ratios`.  Over clutter of all kinds that mean is 1; where the
 * frame's own looks like lamps, a lamp's looks say so much less. */
static double log_mean_ratio(const frame_t *frame, int32_t count, double ratios)
{
    double supposed = frame->constants->likeness_supposed;
    return log((supposed + larger(ratios, 0)) /
               (supposed + (count > 0 ? count : 0)));
}

static double set_evidence(const frame_t *frame, int32_t size,
                           const int32_t *members, const double *along)
{
    strengths_t strengths = {0};
    double likeness = 0, ratios = frame->ratios;
    for (int32_t i = 0; i < size; i++) {
        const peak_t *peak = &frame->peaks[members[i]];
        ratios -= peak->ratio;
        add_strength(&strengths, peak->log_snr, peak->weight, peak->log_density,
                     along[i]);
        likeness += peak->likeness;
    }
    likeness -= size * log_mean_ratio(frame, frame->count - size, ratios);
    return log_alike(frame->constants, &strengths) + likeness +
           set_rarity(frame, size, members) + set_colour(frame, size, members);
}

int32_t evidence_of_sets(const evidence_constants_t *constants,
                         const evidence_peaks_t *peaks, int32_t sets,
                         int32_t size, const int32_t *members,
                         const double *along, double *evidence)
{
    frame_t frame;
    if (peaks->count > SEARCH_MAX_PEAKS || size > peaks->count)
        return -1;
    prepare_frame(&frame, constants, peaks);
    for (int32_t i = 0; i < sets; i++)
        evidence[i] =
            set_evidence(&frame, size, members + (ptrdiff_t)i * size, along);
    return 0;
}

/* ---- The search ---- */

/* Peaks here are the promising ones, numbered from 0. */
typedef struct {
    frame_t frame;
    const search_dock_t *dock;
    double least;
    int32_t count;
    const int32_t *promising;
    double place_x[SEARCH_MAX_PROMISING], place_y[SEARCH_MAX_PROMISING];
    /* Bounds, whatever the other members of a set are: of a peak's rarity and
     * likeness; of the sum of so many peaks'; of the log ratio that one peak's
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
    return larger(rarity(frame, peak, stronger, nearby, count, most, strongest),
                  rarity(frame, peak, stronger, nearby, count, larger(least, 0),
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
    return clutter_colour(frame, peak, peak->everywhere - itself - others,
                          frame->count - size, peak->nearby - itself - others,
                          peak->around - 1);
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
    double sorted[SEARCH_MAX_PEAKS] = {0}, ratios = frame->ratios;
    for (int32_t i = 0; i < frame->count; i++)
        sorted[i] = frame->peaks[i].ratio;
    qsort(sorted, (size_t)frame->count, sizeof(double), descending);
    for (int32_t i = 0; i < markers; i++)
        ratios -= sorted[i];
    double usual = log_mean_ratio(frame, frame->count - markers, ratios);
    for (int32_t i = 0; i < search->count; i++) {
        search->rarity[i] = peak_at(search, i)->likeness - usual +
                            most_rarity(frame, search->promising[i], markers);
        search->rarest[i + 1] = search->rarity[i];
        search->nearest_colour[i] = 0;
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
            double ratio = i == j ? 0 : log(colour_ratio(frame, same, clutter));
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
        all = log_alike(constants, &strengths);
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
    double rarity = search->rarest[others], colour = -INFINITY;
    for (int32_t i = 0; i < k; i++) {
        const double *ratios = search->colour[search->set[i]];
        double common = others * search->nearest_colour[search->set[i]];
        for (int32_t j = 0; j < k; j++)
            common += ratios[search->set[j]];
        colour = larger(colour, common);
        rarity += search->rarity[search->set[i]];
    }
    return log_alike(search->frame.constants, strengths) +
           search->strengths_left[k] + rarity + colour;
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
        set_evidence(&search->frame, markers, set, search->dock->along);
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
        if (fabs(view.across) < window->slope * view.along + slack &&
            view.square > shortest && view.square < longest)
            views[count++] = view;
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
            double turned = atan2(base->across, base->along) / dock->roll_rad;
            place = -0.5 * square(turned) - dock->log_spread -
                    log(search->frame.area) -
                    (dock->markers - 1) * log(base->square);
            take(search, 0, search->set[0], 0, 0, &strengths);
            take(search, 1, base->peak, 1, 0, &strengths);
            take(search, 2, third, x, y, &strengths);
            looks = hoped_looks(search, 3, &strengths);
        }
        double there = place + dock->log_norm[class] - 0.5 * off;
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
            if (x > box->left && x < box->right && y > box->top &&
                y < box->bottom && side->peak != base->peak)
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
    if (peaks->count > SEARCH_MAX_PEAKS ||
        promising_count > SEARCH_MAX_PROMISING)
        return -1;
    if (promising_count < dock->markers || most_sets < 1)
        return 0;
    prepare_frame(&search.frame, constants, peaks);
    search.dock = dock;
    search.least = least;
    search.count = promising_count;
    search.promising = promising;
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
