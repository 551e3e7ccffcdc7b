/* ESP-IDF's version: 4 unless the suite chooses 5.
 *
 * What these headers declare is what the firmware uses, no more, with the
 * signatures of the vendor's own headers. They were compared by hand with
 *   ESP-IDF 4.4.7 (tag v4.4.7; Arduino core 2.0.17),
 *   ESP-IDF 5.5 (branch release/v5.5 at dd8d7946bb4; Arduino core 3.3),
 *   esp32-camera f0bb429 (2.0.8; of Arduino core 2.0.17) and 2ac69a6 (2.1.5+).
 */
#ifndef ESP_IDF_VERSION_H
#define ESP_IDF_VERSION_H

#ifndef ESP_IDF_VERSION_MAJOR
#define ESP_IDF_VERSION_MAJOR 4
#endif

#endif
