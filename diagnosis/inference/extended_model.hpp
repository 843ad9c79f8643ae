#pragma once

#include "diagnosis/inference/diagnosis_result.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

// What a written model keeps of a diagnosis: sizes by name, and so at most one place of a name.

/// Adds to `d.extended` the effects that belong to the vehicle's model. Left out: effects of one
/// drive of several, noise that the simulation does not have (of reference poses, of observations),
/// and effects of one place (with a note). A hinge and a step of the exposure stay, because
/// diagnosis finds their place again. Of several effects of one name, the one with the most
/// evidence is taken.
void extend_model(Diagnosis& d);

/// Adds the known effects (`--model`) to `d.extended`. A size found in addition to a known one is
/// added to it, unless it acts in another place. Notes known effects without a place, by which no
/// reading was corrected.
void add_known(const EffectSizes& known, Diagnosis& d);

/// Notes of known effects without a place, whose name begins with `stream`, that they were left.
void note_without_place(const EffectSizes& known, const std::string& stream, Diagnosis& d);

}  // namespace roadbook
