// Sine, cosine and angles that are the same to the bit on every machine. Context: any.
//
// The nearest of 64 places in a quarter turn comes from a table, and from there it is at most
// 0.0123 rad:
//   cos(a + d) = C - (C v + S s)    sin(a + d) = S + (C s - S v)    s = sin d, v = 1 - cos d
// where a few terms of the series are exact to the last bit.
#include "stepper/trig.h"

#include <math.h>
#include <stdbool.h>

#define STEPS_LOG2 24           // of 2^-32 turns between two places of the table
#define RADIANS_Q60 1686629713u // 2 pi 2^-32: from 2^-32 turns to radians in 2^-60

// sin(i / 64 of a quarter turn) in 2^-31.
static const uint32_t quarter[65] = {
    0u,          52701887u,   105372028u,  157978697u,  210490206u,  262874923u,  315101295u,
    367137861u,  418953276u,  470516330u,  521795963u,  572761285u,  623381598u,  673626408u,
    723465451u,  772868706u,  821806413u,  870249095u,  918167572u,  965532978u,  1012316784u,
    1058490808u, 1104027237u, 1148898640u, 1193077991u, 1236538675u, 1279254516u, 1321199781u,
    1362349204u, 1402678000u, 1442161874u, 1480777044u, 1518500250u, 1555308768u, 1591180426u,
    1626093616u, 1660027308u, 1692961062u, 1724875040u, 1755750017u, 1785567396u, 1814309216u,
    1841958164u, 1868497586u, 1893911494u, 1918184581u, 1941302225u, 1963250501u, 1984016189u,
    2003586779u, 2021950484u, 2039096241u, 2055013723u, 2069693342u, 2083126254u, 2095304370u,
    2106220352u, 2115867626u, 2124240380u, 2131333572u, 2137142927u, 2141664948u, 2144896910u,
    2146836866u, 2147483648u,
};

// The upper half of the product. The 64-bit product of a core without one is a call and costs twice
// as much.
static inline uint32_t upper_product(uint32_t a, uint32_t b) {
    uint32_t low = (a & 0xffff) * (b & 0xffff);
    uint32_t middle = (a >> 16) * (b & 0xffff) + (low >> 16);
    uint32_t other = (a & 0xffff) * (b >> 16) + (middle & 0xffff);
    return (a >> 16) * (b >> 16) + (middle >> 16) + (other >> 16);
}

// Of an angle in the first quarter turn, in 2^-31.
static void sin_cos_of_quarter(uint32_t angle, uint32_t *cos, uint32_t *sin) {
    uint32_t place = (angle + (1u << (STEPS_LOG2 - 1))) >> STEPS_LOG2;
    int32_t rest = (int32_t)(angle - (place << STEPS_LOG2));
    uint32_t size = (uint32_t)(rest < 0 ? -rest : rest);

    uint32_t d = upper_product(size << 8, RADIANS_Q60); // 2^-36 rad, below 2^30
    uint32_t d2 = upper_product(d, d);                  // 2^-40, below 2^28
    uint32_t d4 = (d2 >> 14) * (d2 >> 14) >> 12;        // 2^-40
    uint32_t v = d2 / 2 - d4 * 2731 / 65536;            // 2731 / 65536: a 24th
    uint32_t d3 = (d >> 16) * (d2 >> 12) >> 12;         // 2^-36
    uint32_t s = d - d3 * 2731 / 16384;                 // a sixth

    uint32_t c0 = quarter[64 - place];
    uint32_t s0 = quarter[place];
    uint32_t across = (upper_product(s0, s << 2) + 32) >> 6;
    uint32_t ahead = (upper_product(c0, s << 2) + 32) >> 6;
    *cos = c0 - ((upper_product(c0, v << 4) + 2048) >> 12) - (rest < 0 ? 0 - across : across);
    *sin = s0 - ((upper_product(s0, v << 4) + 2048) >> 12) + (rest < 0 ? 0 - ahead : ahead);
}

trig_t trig_sin_cos(uint32_t angle) {
    uint32_t cos, sin;
    sin_cos_of_quarter(angle & 0x3fffffffu, &cos, &sin);
    int32_t c = (int32_t)((cos + 1) >> 1);
    int32_t s = (int32_t)((sin + 1) >> 1);
    switch (angle >> 30) {
    case 0:
        return (trig_t){c, s};
    case 1:
        return (trig_t){-s, c};
    case 2:
        return (trig_t){-c, -s};
    default:
        return (trig_t){s, -c};
    }
}

#define PER_RADIAN 0.15915494309189535 // turns

// A guess that is at most 0.004 rad off; then the vector is turned back by it, and what is left of
// it is small enough for the series of the arc sine.
double trig_angle(double x, double y) {
    double ax = fabs(x);
    double ay = fabs(y);
    bool steep = ay > ax;
    double t = steep ? ax / ay : ay / ax;
    double guess = t < 0.004 ? 0.0 : t * (0.125 + 0.0435 * (1.0 - t));
    guess = steep ? 0.25 - guess : guess;
    guess = x < 0.0 ? 0.5 - guess : guess;
    guess = y < 0.0 ? -guess : guess;

    int64_t guess_fixed = (int64_t)(guess * TRIG_TURN);
    trig_t turned = trig_sin_cos((uint32_t)guess_fixed);
    double cross = y * turned.cos - x * turned.sin;
    double off = cross / (sqrt(x * x + y * y) * TRIG_ONE);
    double rest = off + off * off * off * (1.0 / 6.0);
    return (double)guess_fixed / TRIG_TURN + rest * PER_RADIAN;
}
