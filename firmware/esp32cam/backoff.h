/* When something that failed is tried again: sooner at first, then ever later,
 * but always again. */
#ifndef BACKOFF_H
#define BACKOFF_H

#include <stdint.h>

/* A loose ribbon is back soon; a supply that sags needs its rest. */
enum { BACKOFF_FIRST_MS = 250, BACKOFF_LONGEST_MS = 16000 };

class Backoff
{
  public:
    void fail(uint32_t now_ms);
    void succeed();

    /* True where the next try may start; at once if nothing failed. */
    bool due(uint32_t now_ms) const;

    /* Between the last failure and the next try; 0: nothing failed. */
    uint32_t delay_ms() const;

  private:
    uint32_t failed_ms = 0;
    uint32_t delay = 0;
};

#endif
