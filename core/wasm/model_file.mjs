// SPDX-License-Identifier: Apache-2.0
// A model file as jsfive finds its way through it: attributes within bounds, datasets and where their bytes are.
const TYPES = { '<f8': 0, '<f4': 1, '<i2': 2, '<i4': 3, '<i8': 4, '<u1': 5, '<i1': 7 };
const OTHER = 6; // of a region's name, text of a fixed length; core refuses what is neither
const LAYOUT = 8; // HDF5's message that says where a dataset's bytes are, and the class of those that lie in one piece:
const CONTIGUOUS = 1;
const MOST_VALUES = 65536; // of all attributes of a file; those of a model have one to three

/** What is wrong with a file, in words for people; jsfive's own errors name no file. */
class Refusal extends Error {}

/** @returns what look() finds  @throws Refusal  where jsfive stumbles: that sentence, or the one that look() throws */
export function reading(look, sentence) {
  try {
    return look();
  } catch (error) {
    throw error instanceof Refusal ? error : new Refusal(sentence, { cause: error });
  }
}

/** From here on jsfive refuses attributes with too many values; it would make an array of them whether or not the file has their bytes. */
function boundValues(found, name) {
  const valueOf = found._attr_value.bind(found); // calls found._attr_value for values within values
  let values = 0;
  found._attr_value = (type, buffer, count, offset) => {
    values += count;
    if (!(count <= MOST_VALUES)) throw new Refusal(`${name}: an attribute has ${count} values, expected one to three`);
    if (!(values <= MOST_VALUES)) throw new Refusal(`${name}: its attributes have more than ${MOST_VALUES} values, expected one to three each`);
    return valueOf(type, buffer, count, offset);
  };
}

/** A file whose attributes can be read within bounds. @throws Refusal */
export function opened(hdf5, bytes, name) {
  const file = reading(() => new hdf5.File(bytes, name), `${name} is no HDF5 file, or a damaged one`);
  boundValues(file._dataobjects, name);
  return file;
}

/** The datasets of a file that lie where a model's do, in a group: path "contact/force", type, shape, bytes and where they begin. */
export function* datasetsOf(file) {
  for (const key of file.keys) {
    const group = file.get(key);
    if (!Array.isArray(group?.keys)) continue;
    for (const name of group.keys) {
      const { dtype, shape, _dataobjects: found } = group.get(name) ?? {};
      if (!shape) continue;
      const bytes = shape.reduce((product, length) => product * length, Number(/\d+$/.exec(dtype)?.[0]));
      const [, , layout, place] = found._get_data_message_properties(found.find_msg_type(LAYOUT)[0].get('offset_to_message'));
      const at = layout === CONTIGUOUS ? Number(new DataView(found.fh).getBigUint64(place, true)) : undefined;
      yield { path: `${key}/${name}`, type: TYPES[dtype] ?? OTHER, shape, bytes, at };
    }
  }
}

/**
 * Refuses, before any memory is taken, what has not all its bytes in the file. Numbers count as they are stored.
 * @param size  of the file  @param before  bytes of the datasets before  @throws Error  file, dataset, found, expected
 */
export function checkPlace(name, { path, bytes, at }, before, size) {
  const fail = (what) => {
    throw new Error(`${name}: /${path} ${what}`);
  };
  if (!(bytes <= size)) fail(`has ${bytes} bytes, more than the file's ${size} can hold`);
  if (!(before + bytes <= size)) fail(`brings the datasets to ${before + bytes} bytes, more than the file's ${size} can hold`);
  if (at === undefined) fail('is not in one piece, expected a contiguous dataset');
  if (bytes > 0 && !(at + bytes <= size)) fail(`ends at byte ${at + bytes}, beyond the file's ${size}`);
}
