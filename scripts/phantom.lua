-- A phantom patient with pectus excavatum: a DICOM CT, the truth beside it, and a scan after the deformity was corrected.
local p = parameters{
  { name = "out", default = "phantom", role = "output", doc = "Folder for the patient" },
  { name = "haller", default = 4, range = { 2, 10 }, doc = "Haller index, as measured on the phantom's own voxels" },
  { name = "type", default = "cup", choices = { "cup", "saucer", "trench", "asymmetric" }, doc = "Type of the deformity" },
  { name = "torsion", default = 0, unit = "deg", range = { 0, 45 }, doc = "Torsion of the sternum" },
  { name = "lift", default = 30, unit = "mm", range = { 0, 120 }, doc = "How far the deepest point of the sternum was lifted in the scan after the operation" },
  { name = "slice_spacing", default = 2.5, unit = "mm", range = { 0.5, 10 }, doc = "Distance between slices" },
  { name = "matrix", default = 512, range = { 128, 512 }, doc = "Pixels along each side of a slice" },
  { name = "noise", default = 18, unit = "HU", range = { 0, 100 }, doc = "Standard deviation of the CT's noise" },
  { name = "seed", default = 1, range = { 0, 1e9 }, doc = "Seed of all randomness: the same seed gives the same bytes" },
}

local ct, truth, scan, ct_landmarks, scan_landmarks = loader.phantom{
  haller = p.haller, type = p.type, torsion = p.torsion, lift = p.lift, slice_spacing = p.slice_spacing,
  matrix = p.matrix, noise = p.noise, seed = p.seed,
}
report.dicom(ct, { path = p.out .. "/dicom" })
report.truth(truth, scan, ct_landmarks, scan_landmarks, { path = p.out .. "/truth" })
print(string.format("Phantom: Haller index %.2f, correction index %.1f %%, pit %.1f mm, %d slices, scan of %d points",
                    truth.haller_index, truth.correction_index, truth.pit_depth, ct.slices // 1, scan.points // 1))
print("CT: " .. p.out .. "/dicom   truth, scan and landmarks: " .. p.out .. "/truth")
