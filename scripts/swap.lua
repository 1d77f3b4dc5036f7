-- One patient through every solver: do they agree, and what does each cost?
local p = parameters{
  { name = "ct", role = "input", doc = "A folder of DICOM files; without it a phantom is solved" },
  { name = "series", doc = "Which series of the folder, if there are several" },
  { name = "matrix", default = 256, range = { 64, 1024 }, doc = "Voxels a side of the phantom's slices" },
  { name = "lift", default = 30, unit = "mm", range = { 0, 120 }, doc = "How far the bar lifts the deepest point of the sternum" },
  { name = "spacing", default = 10, unit = "mm", range = { 1, 50 }, doc = "Distance between neighbouring points of the model" },
  { name = "tolerance", default = 1e-5, range = { 1e-10, 0.5 }, doc = "Largest free force over the largest spring force at which each may stop" },
  { name = "only", doc = "Name of one solver to run beside the reference; default: all" },
}

local ct = p.ct and loader.dicom{ path = p.ct, series = p.series } or loader.phantom{ matrix = p.matrix }
local cage = splines.cartilage(segmenter.thorax(ct), ct)
local skin = { compression = 0.02 }   -- slack skin gives way, as in correction.lua
local scene = model.two_layer(cage, {
  spacing = p.spacing,
  effects = { effect.stretch(skin), effect.shear(skin), effect.bend(skin), effect.direct{}, effect.cross{}, effect.attachment{} },
})
local plan = planner.nuss(cage, { lift = p.lift })

-- The reference: the tightest that Newton reaches.
local reference = solver.newton(scene, plan, { tolerance = 1e-10, accept_unconverged = true, max_iterations = 5000 })
print(string.format("%d skin points, lift %g mm, tolerance %g; reference: newton to a residual of %.1e", scene.skin_points // 1, p.lift, p.tolerance,
                    reference.relative_residual))

-- A motion that is not at rest is listed too: that is what is to be seen here.
local row = "%-24s %10s %10s %9s %10s %10s %9s  %s"
print(row:format("solver", "max, mm", "RMS, mm", "s", "iterations", "forces", "residual", "status"))
for _, s in ipairs{ { "newton" }, { "multigrid" }, { "lbfgs" }, { "projective" }, { "implicit" }, { "implicit", "bdf2" }, { "semi_implicit" }, { "verlet" }, { "xpbd" } } do
  local name, scheme = s[1], s[2]
  if not p.only or p.only == name then
    -- Position-based steps come so near only by becoming ever shorter.
    local tolerance = name == "xpbd" and math.max(p.tolerance, 1e-3) or p.tolerance
    local motion = solver[name](scene, plan, { tolerance = tolerance, scheme = scheme, accept_unconverged = true })
    local c = comparer.surface(motion.after, reference.after, { name = "swap" })
    local max, rms = math.max(c.overlap_max, -c.overlap_min), c.overlap_rms
    print(row:format(scheme and name .. ", " .. scheme or name, ("%.2e"):format(max), ("%.2e"):format(rms), ("%.3f"):format(motion.seconds),
                     motion.iterations // 1, motion.force_evaluations // 1, ("%.1e"):format(motion.relative_residual), motion.status))
  end
end
