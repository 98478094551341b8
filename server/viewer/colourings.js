// What colours the network. Classes go from the best to the worst, as in the report of a map: blue is good, red is bad,
// and neighbouring colours differ in lightness, too. `short` is for the legend, where the unit stands in the heading.

const GOOD_TO_BAD = ['v0', 'v1', 'v2', 'v3', 'v4'];
const MANY_TO_FEW = ['q4', 'q3', 'q2', 'q1', 'q0'];

const atLeast = (limits) => [...limits.map((limit) => `≥ ${limit}`), `< ${limits.at(-1)}`];
const atMost = (limits) => [...limits.map((limit) => `≤ ${limit}`), `> ${limits.at(-1)}`];

export const COLOURINGS = [
  {id: 'landmarks', name: 'landmarks', heading: 'landmarks a metre', unit: 'landmarks a metre', value: 'landmarks_per_m', decimals: 1, limits: [12, 8, 4, 2],
    names: atLeast([12, 8, 4, 2]), colours: GOOD_TO_BAD, without: 'no landmarks',
    caption: 'Landmarks of the default method that begin there, by the tile index.'},
  {id: 'fit', name: 'fit', heading: 'features that fit, %', unit: '% of features fit', value: 'fit_percent', decimals: 0, limits: [95, 85, 70, 50],
    names: atLeast([95, 85, 70, 50]), colours: GOOD_TO_BAD, without: 'not recorded', needsMapping: true,
    caption: 'The share of the features followed in the images of all drives that fit the adjusted poses. Where it is low, the images contradict the recorded poses or the camera.'},
  {id: 'reprojection', name: 'reprojection', heading: 'reprojection error, px', unit: 'px reprojection error', value: 'reprojection_px', decimals: 2, limits: [0.5, 0.75, 1, 1.5], isLessBetter: true,
    names: atMost([0.5, 0.75, 1, 1.5]), colours: GOOD_TO_BAD, without: 'not recorded', needsMapping: true,
    caption: 'How far the features that fit are from where the adjusted poses would see them: root mean square.'},
  {id: 'passes', name: 'passes', heading: 'passes of drives', unit: 'passes', value: 'passes', decimals: 0, limits: [8, 4, 3, 2],
    names: ['≥ 8', '4 to 7', '3', '2', '1'], colours: MANY_TO_FEW, without: 'not told',
    caption: 'How often drives passed the segment. With one pass the map cannot tell its own error.'},
  {id: 'sigma', name: 'position error', heading: 'σ of the map’s positions, m', unit: 'm position error (σ)', value: 'sigma_m', decimals: 2, limits: [0.05, 0.1, 0.2, 0.5], isLessBetter: true,
    names: atMost([0.05, 0.1, 0.2, 0.5]), colours: GOOD_TO_BAD, without: 'not known',
    caption: 'The standard deviation of the map’s own positions on each axis in plan: stated, told by how drives differ, or assumed.'},
];

export const colouringOf = (id) => COLOURINGS.find((each) => each.id === id) ?? COLOURINGS[0];

// The number of the class of a stretch, null without a value. A limit belongs to the better class.
export function classOf(colouring, stretch) {
  const value = stretch[colouring.value];
  if (value === null) return null;
  const at = colouring.limits.findIndex((limit) => colouring.isLessBetter ? value <= limit : value >= limit);
  return at < 0 ? colouring.limits.length : at;
}

// The name of the style sheet's variable.
export const colourName = (colouring, number) => number === null ? 'none' : colouring.colours[number];

// Runs of neighbouring stretches of one class: {class, from_m, to_m}.
export function runsOf(colouring, stretches) {
  const runs = [];
  for (const stretch of stretches) {
    const number = classOf(colouring, stretch), last = runs.at(-1);
    if (last && last.class === number) last.to_m = stretch.to_m;
    else runs.push({class: number, from_m: stretch.from_m, to_m: stretch.to_m});
  }
  return runs;
}
