// One walk through the window, as a user would take it, on any target.
#pragma once

#include "app/view/hand.h"

#include <vector>

namespace pectora::view {

/// What a target showed on the walk. Pictures are RGBA, of the whole window.
struct Walk {
  std::vector<unsigned char> empty, opened, lifted, sawDistances;
  ImVec4 scene;                     ///< the scene's place in them
  int width = 0, height = 0;
  double lift = 0, level = 0;       ///< of the bar after it was dragged
};

/// Opens a phantom, drags the bar in the scene, drags a stiffness, undoes and redoes, turns an effect off and on, places landmarks
/// on both surfaces, and takes a screenshot into `folder`; expects what each must do.
Walk walkThrough(App& app, Hand& hand, const Target& target, const std::string& folder);

/// Keeps the user's own recent files and layout out of a test: a home of the test's own. Returns it.
std::string ownHome(const std::string& name);

/// Mean absolute difference of two pictures within a rectangle (x, y, width, height), in grey levels of 255.
double meanDifference(const std::vector<unsigned char>& a, const std::vector<unsigned char>& b, int width, ImVec4 part);
/// Means of red, green and blue within a rectangle.
std::array<double, 3> meanColor(const std::vector<unsigned char>& rgba, int width, ImVec4 part);

}  // namespace pectora::view
