-- How the wall swings when the bar is put in place: the way in time, and what its accuracy costs.
local p = parameters{
  { name = "ct", role = "input", doc = "A folder of DICOM files; without it a phantom swings" },
  { name = "series", doc = "Which series of the folder, if there are several" },
  { name = "matrix", default = 256, range = { 64, 1024 }, doc = "Voxels a side of the phantom's slices" },
  { name = "lift", default = 30, unit = "mm", range = { 0, 120 }, doc = "How far the bar lifts the deepest point of the sternum" },
  { name = "spacing", default = 12, unit = "mm", range = { 1, 50 }, doc = "Distance between neighbouring points of the model" },
  { name = "duration", default = 0.25, unit = "s", range = { 0.001, 100 }, doc = "How long the wall is followed" },
  { name = "lifting", default = 0.1, unit = "s", range = { 0, 100 }, doc = "Time in which the bar comes to its place" },
  { name = "damping", default = 30, unit = "1/s", range = { 0, 1e6 }, doc = "Damping of the tissue's velocity" },
  { name = "out", role = "output", doc = "Folder for the finest motion as a table and a series of surfaces; none is written without it" },
}

local ct = p.ct and loader.dicom{ path = p.ct, series = p.series } or loader.phantom{ matrix = p.matrix }
local cage = splines.cartilage(segmenter.thorax(ct), ct)
local skin = { compression = 0.02 }   -- slack skin gives way, as in correction.lua
local wall = { effect.stretch(skin), effect.shear(skin), effect.bend(skin), effect.direct{}, effect.cross{}, effect.attachment{} }
local plan = planner.nuss(cage, { lift = p.lift })
local rest = solver.newton(model.two_layer(cage, { spacing = p.spacing, effects = wall }), plan)

table.insert(wall, effect.inertia{ duration = p.duration, lifting = p.lifting, damping = p.damping })
local scene = model.two_layer(cage, { spacing = p.spacing, effects = wall })

-- The reference: steps far below what the explicit scheme needs to be stable.
local safe = solver.verlet(scene, plan, { max_iterations = 1e7 })
local reference = solver.verlet(scene, plan, { time_step = p.duration / safe.iterations / 4, max_iterations = 1e7 })
local function apart(a, b)
  local c = comparer.surface(a.after, b.after, { name = "swing" })
  return math.max(c.overlap_max, -c.overlap_min)
end
print(("%d skin points, lift %g mm in %g s, followed for %g s: up to %.0f mm/s, %.2f mm beyond the end on the way, %.2f mm from rest at the end"):format(
  scene.skin_points // 1, p.lift, p.lifting, p.duration, reference.fastest, reference.overshoot, apart(reference, rest)))

local row = "%-20s %10s %8s %9s %14s %14s  %s"
print(row:format("solver", "step, ms", "steps", "s", "end off, mm", "overshoot, mm", "status"))
local function show(name, motion)
  print(row:format(name, ("%.3g"):format(1000 * motion.duration / motion.iterations), motion.iterations // 1, ("%.3f"):format(motion.seconds),
                   ("%.2e"):format(apart(motion, reference)), ("%.3f"):format(motion.overshoot), motion.status))
end
show("verlet", reference)
show("verlet", safe)
show("semi_implicit", solver.semi_implicit(scene, plan, { max_iterations = 1e7 }))
for _, scheme in ipairs{ "bdf2", "euler" } do
  for _, step in ipairs{ 0.02, 0.01, 0.005, 0.0025 } do
    show("implicit, " .. scheme, solver.implicit(scene, plan, { scheme = scheme, time_step = step, tolerance = 1e-4, accept_unconverged = true }))
  end
end
if p.out then report.files{ cage = cage, scene = scene, plan = plan, motion = reference, path = p.out } end
