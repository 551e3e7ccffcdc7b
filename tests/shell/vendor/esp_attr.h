/* Where ESP-IDF places variables; see esp_camera.h for what these files are. */
#ifndef ESP_ATTR_H
#define ESP_ATTR_H

#define RTC_NOINIT_ATTR

#endif
