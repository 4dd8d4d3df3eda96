// What every part of the firmware may use: errors, checksums, the one-writer one-reader ring,
// decimal numbers from and to text, formatted text, letters.
// The face of firmware/base. Context of each part is said in its own header.
#ifndef BASE_H
#define BASE_H

#include "base/crc.h"
#include "base/err.h"
#include "base/format.h"
#include "base/letters.h"
#include "base/num.h"
#include "base/num_text.h"
#include "base/ring.h"

#define COUNT_OF_ARRAY(array) (sizeof(array) / sizeof((array)[0]))

#endif
