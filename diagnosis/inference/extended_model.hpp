#pragma once

#include "diagnosis/inference/findings.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

// What a written model keeps of a diagnosis: sizes by name, and so at most one place of a name.

/// Adds to `d.extended` what of its causes a model of the vehicle keeps: not what is of one drive
/// of several, nor noise that the simulation has not (of reference poses, of views), nor what acts
/// in one place (a note says so). A hinge and a step of the exposure, whose place diagnosis finds
/// again, stay in; of several of one name the one with the most evidence.
void extend_model(Diagnosis& d);

/// Adds to `d.extended` what the model knew already (`--model`). A size found beside a known one is
/// added to it, but for one that acts in another place. Notes what the model says and no reading
/// was corrected by, since it has no place.
void add_known(const EffectSizes& known, Diagnosis& d);

/// Notes of known effects without a place, whose name begins with `stream`, that they were left.
void note_without_place(const EffectSizes& known, const std::string& stream, Diagnosis& d);

}  // namespace roadbook
