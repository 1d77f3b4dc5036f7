-- The whole way: from the CT before a Nuss operation to the predicted skin, and how far that is from a scan after it.
local p = parameters{
  { name = "ct", role = "input", doc = "The CT before the operation: a folder of DICOM files, or a DICOMDIR" },
  { name = "series", doc = "Which series of the folder, if there are several; default: the largest axial CT" },
  { name = "scan", role = "input", doc = "A 3-D scan after the operation: FastSCAN text, PLY, STL or OBJ; without it nothing is compared" },
  { name = "scan_units", default = "", choices = { "", "mm", "cm", "m", "inch" }, doc = "Unit of the scan; empty: mm if that is the size of a torso" },
  { name = "landmarks", role = "input", doc = "Landmarks on the CT's skin and on the scan: name,ct_x,ct_y,ct_z,scan_x,scan_y,scan_z" },
  { name = "registration", default = "rigid", choices = { "rigid", "similarity", "affine" }, doc = "How the scan is brought onto the CT; affine is the paper's" },
  { name = "icp", default = true, doc = "After the landmarks, bring the scan closer by the surfaces that the operation does not change" },
  { name = "lift", default = 30, unit = "mm", range = { 0, 120 }, doc = "How far the bar lifts the sternum: its deepest point, or the one at level" },
  { name = "level", default = 0, unit = "mm", range = { -150, 150 }, doc = "Height of the bar above (+) or below (-) the deepest point of the sternum" },
  { name = "tilt", default = 0, unit = "deg", range = { -45, 45 }, doc = "How the bar lies across the chest: the patient's left end higher (+) or lower (-)" },
  { name = "second_level", default = 0, unit = "mm", range = { -150, 150 }, doc = "Height of a second bar above (+) or below (-) the first; 0: there is none" },
  { name = "second_lift", default = 20, unit = "mm", range = { 0, 120 }, doc = "How far the second bar lifts the sternum there" },
  { name = "model", default = "two_layer", choices = { "two_layer", "volume_mesh" }, doc = "The wall as two layers of points joined by springs, or as a solid of fat, muscle and bone" },
  { name = "spacing", default = 10, unit = "mm", range = { 1, 50 }, doc = "Distance between neighbouring points of the model" },
  { name = "skin_compression", default = 0.02, range = { 0, 1 }, doc = "Part of the skin's stiffness that acts in compression: skin that becomes slack gives way; 1: the paper's springs" },
  { name = "attachment", default = "carried", choices = { "carried", "struts" }, doc = "How the pleura hangs on the bones: drawn to where they carry it, or by the paper's springs, which turn freely" },
  { name = "contact", default = true, doc = "Ribs, cartilages and sternum are in the pleura's way; without it and volume solvers for springs alone can be taken" },
  { name = "volume", default = true, doc = "The cells between skin and pleura keep their volume, so that the wall does not fold into itself" },
  { name = "effects", default = 0, unit = "mm", range = { 0, 100 }, doc = "Of all installed effects run those that change the skin by about so much or more, which rough solves tell; 0: those of this script" },
  { name = "solver", default = "verlet", doc = "Name of the solver, see `pectora list`" },
  { name = "accuracy", default = 0, unit = "mm", range = { 0, 10 }, doc = "Choose model, spacing and solver for the least time in which the computed skin comes about so near (RMS in the pit) to a far finer computation; 0: as given" },
  { name = "edge", default = "subpixel", choices = { "subpixel", "paper" }, doc = "Where the skin lies: the steepest grey value, or the paper's first pixel" },
  { name = "slices", default = 20, range = { 0, 1000 }, doc = "Number of slice pictures with contours" },
  { name = "out", default = "result", role = "output", doc = "Folder for the results" },
}

-- Anatomy: bones, skin and pleura from the CT; ribs and cartilages as curves.
local ct = loader.dicom{ path = p.ct, series = p.series }
local anatomy = segmenter.thorax(ct, { edge = p.edge })
local cage = splines.cartilage(anatomy, ct)

-- What accuracy costs was studied by scripts/accuracy.lua.
local choice = { model = p.model, spacing = p.spacing, solver = p.solver }
if p.accuracy > 0 then
  choice = require("accuracy_choices").choose(p.accuracy)
  print(string.format("accuracy %g mm: %s at %g mm spacing, solver.%s to %g, expects %.2f mm and about %.2f s", p.accuracy, choice.model, choice.spacing,
                      choice.solver, choice.tolerance, choice.expected, choice.seconds))
end

-- Model: the wall as springs or as a solid, and the effects that this scene calls for.
local skin = { compression = p.skin_compression }
local effects = { effect.stretch(skin), effect.shear(skin), effect.bend(skin), effect.attachment{ hold = p.attachment } }   -- within the skin; pleura to rib cage
if p.contact then effects[#effects + 1] = effect.rib_contact{} end
local isLattice = choice.model == "two_layer"
for _, e in ipairs(isLattice and { effect.direct{}, effect.cross{} } or { effect.tissue{} }) do effects[#effects + 1] = e end   -- between skin and pleura
if isLattice and p.volume then effects[#effects + 1] = effect.volume{} end
if p.effects > 0 then effects[#effects + 1] = "auto" end
local wall = { spacing = choice.spacing, effects = effects, accuracy = p.effects }
local scene
if isLattice then scene = model.two_layer(cage, wall) else scene = model.volume_mesh(cage, ct, wall) end

-- Operation: the bar lifts the sternum, or two do, and the solver finds the skin.
local plan = planner.nuss(cage, { lift = p.lift, level = p.level, tilt = p.tilt, second_level = p.second_level, second_lift = p.second_lift })
local motion = solver[choice.solver](scene, plan, { tolerance = choice.tolerance })

-- What the operation changes, and how far the prediction is from the scan.
local comparisons = {
  comparer.surface(motion.before, motion.after, { name = "ct_vs_simulated", unchanged = motion.before }),
}
local registrations, aligned = {}, nil
if p.scan then
  local scanned = scan.file{ path = p.scan, units = p.scan_units }
  aligned, registrations[1] = register.landmarks(scanned, scan.landmarks{ path = p.landmarks, set = "scan" },
                                                 scan.landmarks{ path = p.landmarks, set = "ct" }, { method = p.registration })
  if p.icp then aligned, registrations[2] = register.icp(aligned, motion.before, motion.after) end
  comparisons[2] = comparer.surface(aligned, motion.after, { name = "scan_vs_simulated", unchanged = motion.before, copied = motion.copied })
end
report.files{ ct = ct, anatomy = anatomy, cage = cage, scene = scene, plan = plan, motion = motion,
              registration = registrations, comparisons = comparisons, scan = aligned, slices = p.slices, path = p.out }

-- The table of the paper: signed distances in mm. The pit is where the prediction moves the skin; the hollow is where the skin before lies
-- behind a string over its front, whatever is predicted: models are to be compared there.
print(string.format("Haller index before %.2f, correction index %.1f %%", anatomy.haller_index, anatomy.correction_index))
print(string.format("%-34s %9s %9s %9s %9s %9s %9s", "signed distance, mm", "points", "mean", "SD", "min", "max", "RMS"))
for _, c in ipairs(comparisons) do
  for _, region in ipairs{ "overlap", "pit", "hollow" } do
    if c[region .. "_points"] > 0 then
      print(string.format("%-34s %9d %+9.2f %9.2f %+9.2f %+9.2f %9.2f", c.name:gsub("_", " ") .. ", " .. region, c[region .. "_points"] // 1,
                          c[region .. "_mean"], c[region .. "_sd"], c[region .. "_min"], c[region .. "_max"], c[region .. "_rms"]))
    end
  end
end
for i, r in ipairs(registrations) do
  print(string.format("registration %d: %s, residual %.2f mm RMS", i, r.method, r.rms))
end
if p.scan then
  local c = comparisons[2]
  local skills = { pit = { "skill", "skill_against_copy" }, hollow = { "hollow_skill", "hollow_skill_against_copy" } }
  for _, region in ipairs{ "pit", "hollow" } do
    if c[region .. "_points"] > 0 then
      print(string.format("scan, %s, RMS: %.2f mm from the prediction, %.2f from nothing changed (skill %.2f), %.2f from skin that copies bone (skill %.2f)", region,
                          c[region .. "_rms"], c["unchanged_" .. region .. "_rms"], c[skills[region][1]], c["copied_" .. region .. "_rms"], c[skills[region][2]]))
    end
  end
end
print("Results are in " .. p.out)
