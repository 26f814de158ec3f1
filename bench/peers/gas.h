/* The gas that engines are compared in: N particles on a ring of length N, elastic, masses 1 and 1.0001 by turns,
 * velocities uniform in [-1, 1), positions displaced from whole numbers by up to a half. */
#include <stdint.h>

static const double heavier = 1.0001;

/* Finaliser of splitmix64. */
static inline uint64_t gas_bits(uint64_t particle) {
  uint64_t z = particle + 0x9E3779B97F4A7C15;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
  return z ^ (z >> 31);
}
static inline double gas_position(uint64_t particle) {
  return (double)particle + (double)(gas_bits(particle) & 0xFFFFFFF) * 0x1p-29;
}
static inline double gas_velocity(uint64_t particle) {
  return (double)(gas_bits(particle) >> 28) * 0x1p-35 - 1;
}
