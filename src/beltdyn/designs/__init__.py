"""Many designs of a drive: batches, studies, sensitivity, optimization, calibration."""
