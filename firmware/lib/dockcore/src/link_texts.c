#include <string.h>

#include "link_parts.h"

void line_add(line_t *line, const char *words)
{
    for (; *words != '\0' && line->length < LINK_TEXT_LENGTH; words++)
        line->text[line->length++] =
            *words >= ' ' && *words <= '~' ? *words : '?';
}

static void add_integer(line_t *line, uint64_t n, int digits)
{
    char text[21];
    int at = sizeof text - 1;
    text[at] = '\0';
    for (; n > 0 || digits > 0; n /= 10, digits--)
        text[--at] = (char)('0' + n % 10);
    line_add(line, text + at);
}

/* Three places, cut off and not rounded: the end of a range that is shown must
 * lie within it. */
void line_add_fixed(line_t *line, int64_t n, uint8_t shift)
{
    const uint64_t magnitude = n < 0 ? 0 - (uint64_t)n : (uint64_t)n;
    const uint64_t thousandths = magnitude * 1000 >> shift;
    if (n < 0)
        line_add(line, "-");
    add_integer(line, thousandths / 1000, 1);
    if (thousandths % 1000 != 0) {
        line_add(line, ".");
        add_integer(line, thousandths % 1000, 3);
    }
}

/* A text that finds no room is dropped: the older ones explain it. */
void link_say(link_t *link, uint8_t severity, const line_t *line)
{
    link_texts_t *texts = &link->texts;
    if (texts->count == LINK_TEXTS)
        return;
    const uint8_t last = texts->count++;
    texts->waiting[last].severity = severity;
    memset(texts->waiting[last].text, 0, LINK_TEXT_LENGTH);
    memcpy(texts->waiting[last].text, line->text, line->length);
}

void link_say_words(link_t *link, uint8_t severity, const char *words)
{
    line_t line = {{0}, 0};
    line_add(&line, words);
    link_say(link, severity, &line);
}

bool link_send_texts(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    (void)now_ms;
    link_texts_t *texts = &dock->link.texts;
    while (texts->count > 0) {
        mavlink_statustext_t text;
        memset(&text, 0, sizeof text);
        text.severity = texts->waiting[0].severity;
        memcpy(text.text, texts->waiting[0].text, sizeof text.text);
        if (!MESSAGE_SEND(sender, STATUSTEXT, &text))
            return false;
        memmove(texts->waiting, texts->waiting + 1,
                --texts->count * sizeof texts->waiting[0]);
    }
    return true;
}
