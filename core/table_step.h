// Checks the time step of a table's digs against its lightest gravel. Light gravel
// trembles at a step that heavy gravel bears, and then resists too little (docs/numerics/dem.md, "A
// step that heats").

#ifndef DIG_CORE_TABLE_STEP_H
#define DIG_CORE_TABLE_STEP_H

#include "core/scene.h"

#define DIG_TABLE_STEP_TEXT_SIZE 192

/// Of a table whose smallest and lightest grains are these; taken_s as in the scene.
struct dig_table_step dig_table_step_of(const struct dig_material *finest,
                                        enum dig_normal_law normal, double lightest_kgpm3,
                                        double taken_s);

/// Writes a sentence for people where a bed of the lightest gravel moves at the step taken; ""
/// where it lies still, which it does at somewhat more than the derived step.
void dig_table_step_text(const struct dig_table_step *step, char text[DIG_TABLE_STEP_TEXT_SIZE]);

#endif // DIG_CORE_TABLE_STEP_H
