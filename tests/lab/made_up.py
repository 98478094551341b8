"""Made-up drives and results for the tests."""
import json
import math
import re

import numpy as np

from laboratory.fixes import PairFixes


def fixes(pair, method, errors_m, sigma_m=1.0, curved=None, lateral_m=None, kb_per_m=4.0, length_m=100.0,
          map_name=None, lateral_error_m=math.nan, lateral_sigma_m=math.nan, heading_error_deg=math.nan,
          latency_ms=70.0):
    """A PairFixes with these errors, frames one metre apart; NaN: not localized."""
    def of_frames(values):
        return np.broadcast_to(np.asarray(values, float), len(errors_m)).copy()

    errors_m = np.asarray(errors_m, float)
    count = len(errors_m)
    return PairFixes(
        pair=pair, method=method, truth_along_m=np.arange(count, dtype=float), error_m=errors_m,
        sigma_m=of_frames(sigma_m),
        curved=np.zeros(count, bool) if curved is None else np.asarray(curved, bool),
        lateral_m=np.zeros(count) if lateral_m is None else np.asarray(lateral_m, float),
        lateral_error_m=of_frames(lateral_error_m), lateral_sigma_m=of_frames(lateral_sigma_m),
        heading_error_deg=of_frames(heading_error_deg), latency_ms=of_frames(latency_ms),
        map_kb_per_m=kb_per_m, map_length_m=length_m, map_name=map_name or f"map-{pair}")


def regression_rows():
    """Rows of a regressions.csv: two features of a fixed size, seen from nearer and nearer."""
    return [{"tracklet": name, "along_m": str(along_m), "scale_px": str(size_px_m / (place_m - along_m))}
            for name, size_px_m, place_m in (("17", 90.0, 40.0), ("4", 200.0, 55.0)) for along_m in range(10, 26, 3)]


def write_drive(folder, frames=1, step_m=1.0, images=None):
    """A drive northwards from the origin, a frame each `step_m` and 0.1 s; `images`: of each frame, its bytes."""
    (folder / "frames").mkdir(parents=True)
    rows, receiver, odometry = [], [], []
    for index in range(frames):
        (folder / f"frames/{index}.jpg").write_bytes(images[index] if images else b"image")
        rows.append(f"{index}.jpg,{index / 10:.4f},0,{index * step_m:.3f},0,0")
        receiver.append(f"{index / 10:.4f},{index * step_m / 111_200:.8f},0,5")
        odometry.append(f"{index / 10:.4f},{10 * step_m},0")
    (folder / "trajectory.csv").write_text("\n".join(["filename,timestamp_s,east_m,north_m,up_m,heading_deg", *rows, ""]))
    (folder / "gps.csv").write_text("\n".join(["timestamp_s,latitude_deg,longitude_deg,sigma_m", *receiver, ""]))
    (folder / "odometry.csv").write_text("\n".join(["timestamp_s,speed_mps,yaw_rate_dps", *odometry, ""]))
    (folder / "drive.json").write_text(json.dumps({
        "name": "a", "camera": {"width_px": 600, "height_px": 400, "focal_px": [400.0, 200.0],
                                "principal_px": [300.0, 250.0]},
        "frame": "local", "origin": {"latitude_deg": 0, "longitude_deg": 0, "altitude_m": 0}, "images": "frames"}))


def data_of(page):
    """What a report shows."""
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)[1])
