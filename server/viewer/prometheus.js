// The text format of Prometheus, as /metrics answers it.

const SAMPLE = /^([a-zA-Z_:][\w:]*)(?:\{(.*)\})?\s+(\S+)(?:\s+-?\d+)?\s*$/;
const LABEL = /([a-zA-Z_]\w*)="((?:[^"\\]|\\.)*)"/g;

const unescaped = (text) => text.replace(/\\(.)/g, (_, c) => c === 'n' ? '\n' : c);
const valueOf = (text) => /^[+-]?Inf$/i.test(text) ? (text.startsWith('-') ? -Infinity : Infinity) : Number(text);

// A histogram's and a summary's samples have names of their own: "x_bucket", "x_sum", "x_count".
function familyOf(families, name) {
  const base = name.replace(/_(bucket|sum|count)$/, '');
  const isPart = base !== name && ['histogram', 'summary'].includes(families.get(base)?.type);
  return isPart ? base : name;
}

// Name -> {type, help, samples: [{name, labels, value}]}. Lines that are not of the format are passed over.
export function familiesOf(text) {
  const families = new Map();
  const family = (name) => {
    if (!families.has(name)) families.set(name, {type: 'untyped', help: '', samples: []});
    return families.get(name);
  };
  for (const line of text.split('\n')) {
    const note = /^#\s+(HELP|TYPE)\s+(\S+)\s*(.*)$/.exec(line);
    if (note) {
      family(note[2])[note[1].toLowerCase()] = note[1] === 'HELP' ? unescaped(note[3]) : note[3].trim();
      continue;
    }
    const sample = line.startsWith('#') ? null : SAMPLE.exec(line);
    if (!sample) continue;
    const labels = Object.fromEntries([...(sample[2] ?? '').matchAll(LABEL)].map(([, key, value]) => [key, unescaped(value)]));
    family(familyOf(families, sample[1])).samples.push({name: sample[1], labels, value: valueOf(sample[3])});
  }
  return families;
}

const total = (samples) => samples.reduce((sum, {value}) => sum + value, 0);

// The cumulated counts of a histogram, over all its other labels: [[upper bound, count], ...], ascending.
function bucketsOf(family) {
  const counts = new Map();
  for (const {name, labels, value} of family.samples) {
    if (name.endsWith('_bucket')) counts.set(valueOf(labels.le), (counts.get(valueOf(labels.le)) ?? 0) + value);
  }
  return [...counts].sort(([a], [b]) => a - b);
}

// The value below which a share of the events since `before` lies, interpolated in its bucket; null without events.
export function quantile(family, before, share) {
  const earlier = new Map(before ? bucketsOf(before) : []);
  const buckets = bucketsOf(family).map(([bound, count]) => [bound, count - (earlier.get(bound) ?? 0)]);
  const wanted = share * (buckets.at(-1)?.[1] ?? 0);
  if (!(wanted > 0)) return null;
  const at = buckets.findIndex(([, count]) => count >= wanted);
  const [low, below] = at > 0 ? buckets[at - 1] : [0, 0];
  const [high, count] = buckets[at];
  return Number.isFinite(high) ? low + (high - low) * (wanted - below) / (count - below) : low;
}

// The sum of a counter's or gauge's samples; of a histogram the number of events.
export function sumOf(family) {
  const isPart = ['histogram', 'summary'].includes(family.type);
  return total(isPart ? family.samples.filter(({name}) => name.endsWith('_count')) : family.samples);
}
