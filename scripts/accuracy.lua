-- What accuracy costs in time: solvers, tolerances, spacings and models on one phantom, each timed and measured.
-- Three errors, never mixed: of the solver (against the same model solved to 1e-8), of model and resolution (against the
-- finest solid), and in all (against the phantom's own skin after the operation, without a scanner's noise).
local p = parameters{
  { name = "haller", default = 4, range = { 2.5, 8 }, doc = "Haller index of the phantom" },
  { name = "lift", default = 20, unit = "mm", range = { 1, 60 }, doc = "How far the bar lifts the deepest point" },
  { name = "skin_compression", default = 0.02, range = { 0, 1 }, doc = "As in correction.lua" },
  { name = "runs", default = 3, range = { 1, 25 }, doc = "How often each run is timed; the median counts, and the spread is told" },
  { name = "quick", default = false, doc = "A small form: one spacing, two tolerances, under a minute" },
  { name = "out", default = "accuracy", role = "output", doc = "Folder for accuracy.csv, accuracy.json and the pictures" },
}
local kScannerNoise = 0.6   -- mm, what a scan repeats to: below it nothing is gained

local ct, truth = loader.phantom{ haller = p.haller, matrix = p.quick and 192 or 256 }
local cage = splines.cartilage(segmenter.thorax(ct), ct)
local plan, nearPlan = planner.nuss(cage, { lift = p.lift }), planner.nuss(cage, { lift = 0.9 * p.lift })
local skin = { compression = p.skin_compression }

-- The models: springs with ever more effects, and the solid.
local function lattice(spacing, set)
  local effects = { effect.stretch(skin), effect.shear(skin), effect.attachment{}, effect.direct{} }
  if set ~= "least" then effects[#effects + 1] = effect.bend(skin); effects[#effects + 1] = effect.cross{} end
  if set == "volume" then
    local nu = { poissons_ratio = 0.45 }
    effects[4], effects[6] = effect.direct(nu), effect.cross(nu)
    effects[#effects + 1] = effect.volume(nu)
  end
  return model.two_layer(cage, { spacing = spacing, effects = effects })
end
local function solid(spacing)
  return model.volume_mesh(cage, ct, { spacing = spacing,
    effects = { effect.stretch(skin), effect.shear(skin), effect.bend(skin), effect.attachment{}, effect.tissue{} } })
end
local spacings = p.quick and { 14 } or { 16, 12, 10, 8 }
local models = {}
for _, s in ipairs(spacings) do
  models[#models + 1] = { name = "lattice", spacing = s, scene = lattice(s, "paper") }
  if not p.quick then
    models[#models + 1] = { name = "lattice, least springs", spacing = s, scene = lattice(s, "least") }
    models[#models + 1] = { name = "lattice with volume", spacing = s, scene = lattice(s, "volume") }
  end
  models[#models + 1] = { name = "solid", spacing = s, scene = solid(s) }
end

-- A motion, the median of its wall and CPU seconds, and the spread. A larger allowance of iterations changes nothing but the key of the cache.
local function timed(solver, scene, settings, start)
  local seconds, cpu, motion = {}, {}, nil
  for k = 1, p.runs do
    local call = { accept_unconverged = true, max_iterations = 20000 + k }
    for name, value in pairs(settings) do call[name] = value end
    motion = start and _G.solver[solver](scene, plan, start, call) or _G.solver[solver](scene, plan, call)
    seconds[k], cpu[k] = motion.seconds, motion.cpu_seconds
  end
  table.sort(seconds)
  table.sort(cpu)
  return motion, seconds[(#seconds + 1) // 2], seconds[#seconds] - seconds[1], cpu[(#cpu + 1) // 2]
end
-- Distances in the pit, where the truth moves by more than 3 mm.
local function distances(sample, reference, before)
  local c = comparer.surface(sample, reference, { name = "accuracy", unchanged = before })
  local region = c.pit_points > 0 and "pit" or "overlap"
  return { rms = c[region .. "_rms"], p95 = c[region .. "_p95_absolute"], max = math.max(c[region .. "_max"], -c[region .. "_min"]) }
end

-- The finest solid is there to be compared with, and is not studied itself.
local finest = { name = "solid", spacing = p.quick and 10 or 6 }
finest.scene = solid(finest.spacing)
finest.best = solver.lbfgs(finest.scene, plan, { tolerance = 1e-6, accept_unconverged = true, max_iterations = 5000 })
-- Its own error, from the next coarser solid: of second order, its distance from that one over (8 / 6)^2 - 1.
local coarser = p.quick and 14 or 8
local next_best = solver.lbfgs(solid(coarser), plan, { tolerance = 1e-6, accept_unconverged = true, max_iterations = 5000 })
finest.off = distances(next_best.after, finest.best.after, finest.best.before).rms / ((coarser / finest.spacing) ^ 2 - 1)
for _, m in ipairs(models) do
  m.near = solver.newton(m.scene, nearPlan, { tolerance = 1e-6, accept_unconverged = true, max_iterations = 5000 })
  m.best = solver.newton(m.scene, plan, { tolerance = 1e-8, accept_unconverged = true, max_iterations = 5000 })
end

local lines = { "model,spacing_mm,points,solver,tolerance,status,seconds,spread_seconds,cpu_seconds,prepare_seconds,warm_seconds,megabytes,force_evaluations,solver_rms_mm,solver_p95_mm," ..
                "solver_max_mm,model_rms_mm,model_p95_mm,model_max_mm,total_rms_mm,total_p95_mm,total_max_mm" }
local head = "%-24s %7s %-14s %9s %9s %9s %9s %9s %6s %9s %11s %10s %10s  %s"
print(string.format("Phantom with Haller index %g, lift %g mm; RMS in the pit, mm; seconds from rest, and warm from nine tenths of the lift, are the median of %d", p.haller, p.lift, p.runs))
print(string.format("Model RMS is against the solid at %g mm, which is %s and itself about %.2f mm off by extrapolation", finest.spacing, finest.best.status, finest.off))
print(head:format("model", "spacing", "solver", "tolerance", "s", "CPU s", "prepare", "warm s", "MB", "forces", "solver RMS", "model RMS", "total RMS", "status"))
local solvers = { "verlet", "semi_implicit", "implicit", "newton", "lbfgs", "multigrid", "projective", "xpbd" }
local tolerances = p.quick and { 1e-2, 1e-4 } or { 1e-1, 1e-2, 1e-3, 1e-4, 1e-5 }
local solverPoints, totalPoints = {}, {}
for _, m in ipairs(models) do
  local isStudied = m.spacing == spacings[#spacings] or m.spacing == 10   -- every solver and tolerance; else one is enough
  local modelError = distances(m.best.after, finest.best.after, m.best.before)
  for _, name in ipairs(solvers) do
    for _, tolerance in ipairs(tolerances) do
      local isWanted = (isStudied and (m.name == "lattice" or (name ~= "projective" and name ~= "xpbd" and name ~= "implicit"))) or (name == "verlet" and tolerance == 1e-3)
      if m.name == "lattice with volume" or m.name == "solid" then isWanted = isWanted and name ~= "projective" and name ~= "xpbd" end
      if name == "xpbd" then isWanted = isWanted and tolerance >= 1e-3 end   -- nearer it comes only by ever shorter steps
      if m.name == "lattice, least springs" then isWanted = name == "verlet" and tolerance == 1e-3 end
      if isWanted then
        local motion, seconds, spread, cpu = timed(name, m.scene, { tolerance = tolerance })
        local _, warm = timed(name, m.scene, { tolerance = tolerance }, m.near)
        local mine, all = distances(motion.after, m.best.after, m.best.before), distances(truth.skin_after, motion.after, m.best.before)
        print(head:format(m.name, m.spacing, name, ("%.0e"):format(tolerance), ("%.3f"):format(seconds), ("%.3f"):format(cpu), ("%.3f"):format(motion.prepare_seconds), ("%.3f"):format(warm), ("%.1f"):format(motion.megabytes), motion.force_evaluations // 1,
                          ("%.2e"):format(mine.rms), ("%.2f"):format(modelError.rms), ("%.2f"):format(all.rms), motion.status))
        local cells = { '"' .. m.name .. '"', m.spacing, m.scene.skin_points, name, tolerance, motion.status, seconds, spread, cpu, motion.prepare_seconds, warm, motion.megabytes, motion.force_evaluations,
                        mine.rms, mine.p95, mine.max, modelError.rms, modelError.p95, modelError.max, all.rms, all.p95, all.max }
        for i, cell in ipairs(cells) do cells[i] = type(cell) == "number" and ("%.6g"):format(cell) or cell end
        lines[#lines + 1] = table.concat(cells, ",")
        if m.name == "lattice" and m.spacing == spacings[#spacings] then solverPoints[#solverPoints + 1] = ("%s;%.6g;%.6g"):format(name, seconds, mine.rms) end
        totalPoints[#totalPoints + 1] = ("%s;%.6g;%.6g"):format(m.name, seconds, all.rms)
      end
    end
  end
end
report.table{ path = p.out .. "/accuracy.csv", lines = lines }
report.table{ path = p.out .. "/accuracy.json", lines = lines }
report.plot{ path = p.out .. "/solver_error.png", title = ("Error of the solver: lattice, %g mm spacing, %g mm lift"):format(spacings[#spacings], p.lift),
             cost = "time from rest, s", error = "RMS in the pit against the same model solved to 1e-8, mm", points = solverPoints,
             floor = kScannerNoise, floor_name = "noise of a scanner" }
report.plot{ path = p.out .. "/total_error.png", title = ("Error in all: models, spacings and solvers, %g mm lift"):format(p.lift),
             cost = "time from rest, s", error = "RMS in the pit against the phantom's skin after the operation, mm", points = totalPoints, lines = false,
             floor = kScannerNoise, floor_name = "noise of a scanner" }
print("Tables and pictures are in " .. p.out)
