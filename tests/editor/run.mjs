// node run.mjs PROGRAM SOURCE_FOLDER CHROMIUM [PART_OF_A_NAME]
import { runAll } from './harness.mjs';
import './building.mjs';
import './living.mjs';
import './looking.mjs';
import './canvas.mjs';
import './forms.mjs';
import './shaping.mjs';

await runAll(process.argv[5]);
