-- What accuracy_choices promises, on two phantoms that its study did not hold: the chosen computation against the finest one.
local choices = require "accuracy_choices"
for _, phantom in ipairs{ { haller = 3.25, type = "saucer", matrix = 256 }, { haller = 5, type = "asymmetric", matrix = 256 } } do
  local ct = loader.phantom(phantom)
  local cage = splines.cartilage(segmenter.thorax(ct), ct)
  local plan = planner.nuss(cage, { lift = 20 })
  local skin = { compression = 0.02 }
  local function solve(choice)
    local effects = { effect.stretch(skin), effect.shear(skin), effect.bend(skin), effect.attachment{} }
    local scene
    if choice.model == "two_layer" then
      effects[5], effects[6] = effect.direct{}, effect.cross{}
      scene = model.two_layer(cage, { spacing = choice.spacing, effects = effects })
    else
      effects[5] = effect.tissue{}
      scene = model.volume_mesh(cage, ct, { spacing = choice.spacing, effects = effects })
    end
    return solver[choice.solver](scene, plan, { tolerance = choice.tolerance, accept_unconverged = true, max_iterations = 20000 })
  end
  local finest = solve{ model = "volume_mesh", spacing = 6, solver = "lbfgs", tolerance = 1e-5 }
  for _, accuracy in ipairs{ 3, 1 } do
    local choice = choices.choose(accuracy)
    local motion = solve(choice)
    local error = comparer.surface(motion.after, finest.after, { name = "promise", unchanged = finest.before }).pit_rms
    print(("%s, Haller %g: promised %g mm by %s at %g mm, found %.2f mm: %s"):format(phantom.type, phantom.haller, accuracy, choice.model, choice.spacing, error,
                                                                                 error <= accuracy and "kept" or "broken"))
  end
end
