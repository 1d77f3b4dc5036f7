// The left column: what can be chosen in each step of the work.
#pragma once

#include "app/view/context.h"

namespace pectora::view {

void patientControls(Context& context);
void barControls(Context& context);
void tissueControls(Context& context);
void accuracyControls(Context& context);
/// What accuracy costs in time in the present scene, as a picture: the centre of that step.
void accuracyPicture(Context& context, float width, float height);
/// The figures of the prediction: the right column.
void figuresPanel(Context& context);
/// What the worker does, with a button to stop it, or what went wrong: the line below.
void statusLine(Context& context);

}  // namespace pectora::view
