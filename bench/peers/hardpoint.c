/* Collisions per second of C. B. Mendl's hardpoint-systems (folder altern_mass), in the gas of gas.h. The headers are
 * copies with the number of particles and of time slots of this build; see CMakeLists.txt.
 *
 *   peer_hardpoint_N_SLOTS SLOT_LENGTH COLLISIONS     prints: particles slots length collisions time seconds
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "collision.h"
#include "event_table.h"
#include "field.h"
#include "gas.h"
#include "simulation.h"

#undef PerformCollision /* the sources are built with PerformCollision=counted_collision where it is called */

static unsigned long long collisions = 0;
current_coll_t counted_collision(const event_t *event, field_t *field) {
  ++collisions;
  return PerformCollision(event, field);
}

static double thread_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(int count, char **arguments) {
  if (count != 3) return fprintf(stderr, "usage: %s SLOT_LENGTH COLLISIONS\n", arguments[0]), 2;
  const double length = atof(arguments[1]), most = atof(arguments[2]);
  static field_t field;
  event_table_t table;
  const double masses[2] = {1, heavier};
  unsigned i;
  Field_Create(masses, &field);
  for (i = 0; i < NUM_SITES; i++) {
    field.pts[i].v = gas_velocity(i);
    field.pts[i].r = i + 1 < NUM_SITES ? gas_position(i + 1) - gas_position(i)
                                       : NUM_SITES - gas_position(i) + gas_position(0);
  }
  EventTable_Allocate(length, &table);
  CollectEvents(&field, &table);
  const double start = thread_seconds();
  double time = 0;
  while ((double)collisions < most) {
    SweepTable(&field, &table);
    GlobalTimeshift(NUM_SLOTS * length, &field, &table);
    time += NUM_SLOTS * length;
  }
  printf("%d %d %g %llu %.17g %.4f\n", NUM_SITES, NUM_SLOTS, length, collisions, time, thread_seconds() - start);
  EventTable_Delete(&table);
  return 0;
}
