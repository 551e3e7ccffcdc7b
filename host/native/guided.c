#include "guided.h"

#include "internal/weighing.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* Markers at most: all but one have a peak each. */
#define MOST_MARKERS (EVIDENCE_MAX_PEAKS + 1)

typedef struct {
    const evidence_frame_t *frame;
    const guided_dock_t *dock;
    double variance; /* of the places of peaks */
    double *whiten;  /* room for the matrix of that name, see weigh_all() */
    /* Of each marker the peaks that may be it, the nearest first, and how far
     * from its place they are: chi-square. */
    int32_t counts[MOST_MARKERS];
    int32_t options[MOST_MARKERS][GUIDED_MOST_OPTIONS];
    double squares[MOST_MARKERS][GUIDED_MOST_OPTIONS];
} guess_t;

/* Markers of which each has a peak: those that are not hidden. */
typedef struct {
    int32_t size;
    int32_t markers[MOST_MARKERS];
    int32_t members[MOST_MARKERS];
    double evidence;
} set_t;

/* Of the places of peaks that are the markers. */
static double covariance_of(const guess_t *guess, int32_t row, int32_t column)
{
    const guided_dock_t *dock = guess->dock;
    return dock->covariance[(ptrdiff_t)row * 2 * dock->markers + column] +
           (row == column ? guess->variance : 0);
}

/* Chi-square of a peak as a marker by itself. */
static double square_of(const guess_t *guess, int32_t marker, int32_t index)
{
    const guided_dock_t *dock = guess->dock;
    const peak_t *peak = &guess->frame->peaks[index];
    const double xx = covariance_of(guess, 2 * marker, 2 * marker);
    const double xy = covariance_of(guess, 2 * marker, 2 * marker + 1);
    const double yy = covariance_of(guess, 2 * marker + 1, 2 * marker + 1);
    const double x = peak->x - dock->places[2 * marker];
    const double y = peak->y - dock->places[2 * marker + 1];
    return (yy * x * x - 2 * xy * x * y + xx * y * y) / (xx * yy - xy * xy);
}

/* Takes a peak among the options of a marker, if it is near enough. */
static void consider(guess_t *guess, int32_t options, int32_t marker,
                     int32_t index, double distance)
{
    int32_t *own = guess->options[marker];
    double *squares = guess->squares[marker];
    int32_t k = guess->counts[marker];
    if (!(distance < GUIDED_GATE))
        return;
    if (k < options)
        guess->counts[marker]++;
    else if (!(distance < squares[--k]))
        return;
    for (; k > 0 && squares[k - 1] > distance; k--) {
        own[k] = own[k - 1];
        squares[k] = squares[k - 1];
    }
    own[k] = index;
    squares[k] = distance;
}

static void find_options(guess_t *guess, int32_t options)
{
    const guided_dock_t *dock = guess->dock;
    memset(guess->counts, 0, sizeof guess->counts);
    for (int32_t i = 0; i < guess->frame->count; i++) {
        double squares[MOST_MARKERS];
        int32_t nearest = 0;
        for (int32_t m = 0; m < dock->markers; m++) {
            squares[m] = square_of(guess, m, i);
            if (squares[m] < squares[nearest])
                nearest = m;
        }
        if (!dock->inside[nearest])
            continue;
        for (int32_t m = 0; m < dock->markers; m++)
            if (dock->inside[m])
                consider(guess, options, m, i, squares[m]);
    }
}

/* The inverse W of the Cholesky factor L of the covariance C of the places of
 * some markers, C = L L': lower triangular, so that W times an error is
 * standard normal.  Returns the log density of the places at their peak. */
static double whiten(const guess_t *guess, const set_t *set)
{
    const int32_t n = 2 * set->size;
    double *W = guess->whiten, log_norm = 0;
    for (int32_t i = 0; i < n; i++) {
        double *row = W + (ptrdiff_t)i * n;
        for (int32_t j = 0; j <= i; j++) {
            const double *other = W + (ptrdiff_t)j * n;
            double sum = covariance_of(guess, 2 * set->markers[i / 2] + i % 2,
                                       2 * set->markers[j / 2] + j % 2);
            for (int32_t k = 0; k < j; k++)
                sum -= row[k] * other[k];
            row[j] = i == j ? sqrt(sum) : sum / other[j];
        }
    }
    for (int32_t i = 0; i < n; i++) {
        double *row = W + (ptrdiff_t)i * n;
        for (int32_t j = 0; j < i; j++) {
            double sum = 0;
            for (int32_t k = j; k < i; k++)
                sum -= row[k] * W[(ptrdiff_t)k * n + j];
            row[j] = sum / row[i];
        }
        row[i] = 1 / row[i];
        log_norm += log(row[i]) - 0.5 * log(2 * PI);
    }
    return log_norm;
}

/* Errors of the places of a set's members in standard deviations, independent
 * of each other; returns chi-square. */
static double whitened(const guess_t *guess, const set_t *set, double *errors)
{
    const int32_t n = 2 * set->size;
    double square_sum = 0;
    for (int32_t i = 0; i < set->size; i++) {
        const peak_t *peak = &guess->frame->peaks[set->members[i]];
        const double *place = guess->dock->places + 2 * set->markers[i];
        errors[2 * i] = peak->x - place[0];
        errors[2 * i + 1] = peak->y - place[1];
    }
    /* From the last on: each takes of those before it what they are in pixels.
     */
    for (int32_t i = n - 1; i >= 0; i--) {
        const double *row = guess->whiten + (ptrdiff_t)i * n;
        double sum = 0;
        for (int32_t j = 0; j <= i; j++)
            sum += row[j] * errors[j];
        errors[i] = sum;
        square_sum += square(sum);
    }
    return square_sum;
}

static bool all_differ(const set_t *set)
{
    for (int32_t i = 0; i < set->size; i++)
        for (int32_t j = 0; j < i; j++)
            if (set->members[i] == set->members[j])
                return false;
    return true;
}

/* The next way to choose one of each marker's options, the last marker's the
 * fastest, like an odometer; false after the last way. */
static bool turn(const guess_t *guess, const set_t *set, int32_t *which)
{
    for (int32_t i = set->size - 1; i >= 0; i--) {
        if (++which[i] < guess->counts[set->markers[i]])
            return true;
        which[i] = 0;
    }
    return false;
}

/* Finds the likeliest peaks for the markers of a set; its evidence becomes
 * -infinity where there is no peak for each. */
static void choose(const guess_t *guess, set_t *set)
{
    const guided_dock_t *dock = guess->dock;
    const double chance =
        set->size == dock->markers ? 1 - GUIDED_HIDDEN : GUIDED_HIDDEN;
    const double most = log(chance) + whiten(guess, set);
    set_t tried = *set;
    int32_t which[MOST_MARKERS] = {0};
    double along[MOST_MARKERS], errors[2 * MOST_MARKERS];
    for (int32_t i = 0; i < set->size; i++)
        along[i] = dock->along[set->markers[i]];
    set->evidence = -INFINITY;
    do {
        for (int32_t i = 0; i < set->size; i++)
            tried.members[i] = guess->options[set->markers[i]][which[i]];
        if (!all_differ(&tried))
            continue;
        tried.evidence =
            most - 0.5 * whitened(guess, &tried, errors) +
            evidence_of_set(guess->frame, set->size, tried.members, along);
        if (tried.evidence > set->evidence)
            *set = tried;
    } while (turn(guess, set, which));
}

/* Which of a set's members are unlikely to be its markers.  Given the others'
 * places a marker's is normal, with the inverse of its own block of the
 * information, W' W, for its covariance. */
static void find_unlikely(const guess_t *guess, const set_t *set,
                          bool *unlikely)
{
    const int32_t n = 2 * set->size;
    double errors[2 * MOST_MARKERS];
    whitened(guess, set, errors);
    for (int32_t i = 0; i < set->size; i++) {
        double xx = 0, xy = 0, yy = 0, x = 0, y = 0;
        for (int32_t k = 2 * i; k < n; k++) {
            const double *w = guess->whiten + (ptrdiff_t)k * n + 2 * i;
            /* Of the marker's first row nothing is right of the diagonal. */
            const double next = k == 2 * i ? 0 : w[1];
            xx += w[0] * w[0];
            xy += w[0] * next;
            yy += next * next;
            x += w[0] * errors[k];
            y += next * errors[k];
        }
        unlikely[i] = yy * x * x - 2 * xy * x * y + xx * y * y >
                      GUIDED_UNLIKELY * (xx * yy - xy * xy);
    }
}

/* All markers but one. */
static set_t without(int32_t markers, int32_t hidden)
{
    set_t set = {.size = 0};
    for (int32_t m = 0; m < markers; m++)
        if (m != hidden)
            set.markers[set.size++] = m;
    return set;
}

/* The likeliest set of all markers, or of all but one. */
static set_t likeliest(const guess_t *guess)
{
    const guided_dock_t *dock = guess->dock;
    const bool spare = dock->markers > dock->least_markers;
    set_t best = {.evidence = -INFINITY};
    int32_t hidden = -1, without_peak = 0;
    for (int32_t m = 0; m < dock->markers; m++)
        if (guess->counts[m] == 0) {
            hidden = m;
            without_peak++;
        }
    if (without_peak > 1 || (without_peak == 1 && !spare))
        return best;
    best = without(dock->markers, hidden);
    choose(guess, &best);
    if (hidden >= 0 || !spare)
        return best;
    bool unlikely[MOST_MARKERS];
    for (int32_t m = 0; m < dock->markers; m++)
        unlikely[m] = true;
    if (best.evidence > -INFINITY)
        find_unlikely(guess, &best, unlikely);
    for (int32_t m = 0; m < dock->markers; m++)
        if (unlikely[m]) {
            set_t others = without(dock->markers, m);
            choose(guess, &others);
            if (others.evidence > best.evidence)
                best = others;
        }
    return best;
}

int32_t guided_guess(const guided_dock_t *dock, const evidence_frame_t *frame,
                     double sigma_px, int32_t options, double *room,
                     int32_t *members, double *evidence)
{
    guess_t guess = {.frame = frame,
                     .dock = dock,
                     .variance = square(sigma_px),
                     .whiten = room};
    *evidence = -INFINITY;
    if (options > GUIDED_MOST_OPTIONS)
        return -1;
    if (frame->count < dock->markers - 1)
        return 0;
    find_options(&guess, options);
    const set_t best = likeliest(&guess);
    for (int32_t m = 0; m < dock->markers; m++)
        members[m] = -1;
    for (int32_t i = 0; i < best.size; i++)
        members[best.markers[i]] = best.members[i];
    *evidence = best.evidence;
    return 0;
}
