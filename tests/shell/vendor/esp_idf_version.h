/* ESP-IDF's version: 4 unless the suite chooses 5.
 *
 * What these headers declare is what the firmware uses, no more, with the
 * signatures of the vendor's own headers. They were compared by hand with
 *   ESP-IDF 4.4.7 (tag v4.4.7; Arduino core 2.0.17),
 *   ESP-IDF 5.5 (branch release/v5.5 at dd8d7946bb4; Arduino core 3.3),
 *   esp32-camera 2.0.4 (e689c3b) and 2.1.5+ (2ac69a6). */
#ifndef ESP_IDF_VERSION_H
#define ESP_IDF_VERSION_H

#ifndef ESP_IDF_VERSION_MAJOR
#define ESP_IDF_VERSION_MAJOR 4
#endif

#endif
